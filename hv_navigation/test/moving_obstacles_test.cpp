#include "hv_navigation/moving_obstacles.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace hv::navigation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

constexpr double kPeriod_s = 0.1;

OccupancyGrid FreeGrid(const Vector2d& origin = {-6.0, -6.0}) {
  OccupancyGrid grid;
  grid.origin = origin;
  grid.width = grid.height = 120;
  grid.cells.assign(120U * 120U, OccupancyGrid::kFree);
  return grid;
}

void AddDisc(OccupancyGrid& grid, const Vector2d& center, double radius_m) {
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      if ((grid.CenterOf({x, y}) - center).norm() <= radius_m) {
        grid.At(x, y) = OccupancyGrid::kOccupied;
      }
    }
  }
}

void AddWall(OccupancyGrid& grid, double x_m) {
  for (int y = 0; y < grid.height; ++y) {
    grid.At(grid.CellOf({x_m, 0.0}).x(), y) = OccupancyGrid::kOccupied;
  }
}

class MovingObstaclesTest : public testing::Test {
 protected:
  std::vector<Walker> Show(const OccupancyGrid& grid) {
    time_s_ += kPeriod_s;
    return moving_.Track(Time::FromSeconds(time_s_), grid, Vector2d::Zero());
  }
  /// Somebody walks for 1.2 s; who is noticed in the end.
  std::vector<Walker> Walk(const Vector2d& from, const Vector2d& velocity) {
    std::vector<Walker> walkers;
    for (int i = 0; i <= 12; ++i) {
      OccupancyGrid grid = FreeGrid();
      AddDisc(grid, from + i * kPeriod_s * velocity, 0.25);
      walkers = Show(grid);
    }
    return walkers;
  }

  MovingObstaclesConfig config_;
  MovingObstacles moving_{config_};
  double time_s_ = 100.0;
};

TEST_F(MovingObstaclesTest, TellsWhereSomebodyWalks) {
  for (const double heading : {0.0, 0.7, 1.57, 2.5, -2.0}) {
    moving_.Clear();
    time_s_ += 10.0;
    const Vector2d ahead(std::cos(heading), std::sin(heading));
    const std::vector<Walker> walkers = Walk(-1.2 * ahead, 1.0 * ahead);
    ASSERT_EQ(walkers.size(), 1U) << heading;
    EXPECT_LT(walkers[0].place.norm(), 0.3) << heading;
    EXPECT_GT(walkers[0].direction.dot(ahead), std::cos(0.4)) << heading;
    EXPECT_EQ(walkers[0].stamp, Time::FromSeconds(time_s_));
  }
}

TEST_F(MovingObstaclesTest, TwoWhoPassAreTwo) {
  std::vector<Walker> walkers;
  for (int i = 0; i <= 12; ++i) {
    OccupancyGrid grid = FreeGrid();
    AddDisc(grid, {-1.2 + 0.1 * i, 0.8}, 0.25);
    AddDisc(grid, {1.2 - 0.1 * i, -0.8}, 0.25);
    walkers = Show(grid);
  }
  ASSERT_EQ(walkers.size(), 2U);
  EXPECT_LT(walkers[0].direction.dot(walkers[1].direction), -0.9);
}

TEST_F(MovingObstaclesTest, WhoIsNotNoticedForAMomentIsStillMinded) {
  const auto minded_s = [&](double x_m, double y_m) {
    moving_.Clear();
    time_s_ += 10.0;
    EXPECT_FALSE(Walk({x_m - 1.2, y_m}, {1.0, 0.0}).empty());
    OccupancyGrid grid = FreeGrid();
    AddDisc(grid, {x_m, y_m}, 0.25);
    // Standing still by now: nothing is newly taken.
    int minded = 0;
    for (int i = 0; i < 30; ++i) minded += Show(grid).empty() ? 0 : 1;
    return minded * kPeriod_s;
  };
  const double noticed_s = config_.compare_s + 2.0 * kPeriod_s;
  EXPECT_GE(minded_s(0.5, 3.0), config_.hold_s - kPeriod_s);
  EXPECT_LE(minded_s(0.5, 3.0), config_.hold_s + noticed_s);
  // Who got out of sight on the way to the robot takes longer to get past it.
  EXPECT_GE(minded_s(-0.9, 0.0), config_.hold_s + 2.0 * noticed_s);
  EXPECT_LE(minded_s(-0.9, 0.0), config_.hold_near_s + noticed_s);
}

TEST_F(MovingObstaclesTest, WhoSlowsDownIsSeenAllTheSame) {
  ASSERT_FALSE(Walk({-1.2, 0.0}, {1.0, 0.0}).empty());
  Vector2d place = Vector2d::Zero();
  for (int i = 0; i < 8; ++i) {
    place.x() += 0.4 * kPeriod_s;
    OccupancyGrid grid = FreeGrid();
    AddDisc(grid, place, 0.25);
    const std::vector<Walker> walkers = Show(grid);
    ASSERT_FALSE(walkers.empty()) << i;
    EXPECT_EQ(walkers.back().stamp, Time::FromSeconds(time_s_)) << i;
    EXPECT_LT((walkers.back().place - place).norm(), 0.3) << i;
  }
}

TEST_F(MovingObstaclesTest, WhatAppearsMayBeSomebody) {
  for (int i = 0; i < 10; ++i) Show(FreeGrid());
  EXPECT_TRUE(moving_.appeared().empty());
  OccupancyGrid grid = FreeGrid();
  AddDisc(grid, {1.0, 1.0}, 0.25);
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(Show(grid).empty());
  ASSERT_FALSE(moving_.appeared().empty());
  EXPECT_LT((moving_.appeared().back().place - Vector2d(1.0, 1.0)).norm(), 0.1);
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(Show(grid).empty()) << "it stays";
  EXPECT_TRUE(moving_.appeared().empty());
}

TEST_F(MovingObstaclesTest, WhatStandsGoesNowhere) {
  for (int i = 0; i < 20; ++i) {
    OccupancyGrid grid = FreeGrid();
    AddDisc(grid, {1.5, 0.3}, 0.3);
    AddWall(grid, 2.5);
    EXPECT_TRUE(Show(grid).empty()) << i;
  }
}

TEST_F(MovingObstaclesTest, WhatComesIntoViewGoesNowhere) {
  for (int i = 0; i < 20; ++i) {
    OccupancyGrid grid = FreeGrid();
    for (int y = 0; y < grid.height; ++y) {
      for (int x = 0; x < grid.width; ++x) {
        if (y > 40 + 2 * i) grid.At(x, y) = OccupancyGrid::kUnknown;
      }
    }
    for (int y = 0; y < std::min(grid.height, 40 + 2 * i); ++y) {
      grid.At(80, y) = OccupancyGrid::kOccupied;
    }
    EXPECT_TRUE(Show(grid).empty()) << i;
  }
}

TEST_F(MovingObstaclesTest, GridsMoveWithTheRobot) {
  for (int i = 0; i < 20; ++i) {
    OccupancyGrid grid = FreeGrid({-6.0 + 0.1 * i, -6.0});
    AddDisc(grid, {1.5, 0.3}, 0.3);
    EXPECT_TRUE(Show(grid).empty()) << i;
  }
}

TEST_F(MovingObstaclesTest, SingleCellsAndWholeWallsAreNoPeople) {
  Show(FreeGrid());
  for (int i = 0; i < 6; ++i) Show(FreeGrid());
  OccupancyGrid speck = FreeGrid();
  AddDisc(speck, {1.0, 0.0}, 0.3);
  for (int i = 0; i < 6; ++i) Show(speck);
  speck.At(90, 60) = OccupancyGrid::kOccupied;
  EXPECT_TRUE(Show(speck).empty());
  OccupancyGrid shifted = FreeGrid();
  AddWall(shifted, 1.0);
  for (int i = 0; i < 8; ++i) Show(shifted);
  OccupancyGrid jump = FreeGrid();
  AddWall(jump, 1.2);
  EXPECT_TRUE(Show(jump).empty());
}

TEST_F(MovingObstaclesTest, NothingIsToldWhenSwitchedOffOrAfterAPause) {
  config_.predict = false;
  MovingObstacles off(config_);
  for (int i = 0; i <= 12; ++i) {
    OccupancyGrid grid = FreeGrid();
    AddDisc(grid, {-1.0 + 0.1 * i, 0.0}, 0.25);
    EXPECT_TRUE(off.Track(Time::FromSeconds(0.1 * i), grid, Vector2d::Zero()).empty());
  }
  EXPECT_FALSE(Walk({-1.0, 0.0}, {1.0, 0.0}).empty());
  time_s_ += 5.0;
  OccupancyGrid grid = FreeGrid();
  AddDisc(grid, {3.0, 3.0}, 0.25);
  EXPECT_TRUE(Show(grid).empty());
}

}  // namespace
}  // namespace hv::navigation
