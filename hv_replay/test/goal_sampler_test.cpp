#include "hv_replay/goal_sampler.h"

#include <gtest/gtest.h>

namespace hv::replay {
namespace {

using navigation::Footprint;
using navigation::PlanarPose;

/// Two rooms of 8 x 6 m beside each other with walls between and around them, cells of 0.1 m.
OccupancyGrid TwoRooms() {
  OccupancyGrid grid;
  grid.width = 160;
  grid.height = 60;
  grid.cells.assign(160 * 60, OccupancyGrid::kFree);
  for (int row = 0; row < 60; ++row) {
    for (const int column : {0, 80, 159}) grid.At(column, row) = OccupancyGrid::kOccupied;
  }
  for (int column = 0; column < 160; ++column) {
    for (const int row : {0, 59}) grid.At(column, row) = OccupancyGrid::kOccupied;
  }
  return grid;
}

TEST(GoalSamplerTest, GoalsHaveRoomAndAreWithinReach) {
  GoalSampler sampler(TwoRooms(), Footprint(), 3);
  const PlanarPose start{{1.0, 3.0}, 0.0};
  const double room_m = Footprint().CircumscribedRadius();
  for (int k = 0; k < 100; ++k) {
    const auto goal = sampler.Next(start, 2.0);
    ASSERT_TRUE(goal);
    const Eigen::Vector2d& at = goal->pose.position;
    EXPECT_LT(at.x(), 8.0 - room_m);
    EXPECT_GT(at.x(), room_m);
    EXPECT_GT((at - start.position).norm(), 2.0);
    EXPECT_GE(goal->optimal_m, (at - start.position).norm() - 0.2);
    EXPECT_LE(goal->optimal_m, 1.09 * (at - start.position).norm() + 0.2);
  }
}

TEST(GoalSamplerTest, TheSeedDecides) {
  const PlanarPose start{{1.0, 3.0}, 0.0};
  const auto first = [&](std::uint32_t seed) {
    return GoalSampler(TwoRooms(), Footprint(), seed).Next(start, 2.0)->pose.position;
  };
  EXPECT_EQ(first(1), first(1));
  EXPECT_NE(first(1), first(2));
}

TEST(GoalSamplerTest, ThereMayBeNone) {
  GoalSampler sampler(TwoRooms(), Footprint(), 3);
  EXPECT_FALSE(sampler.Next({{1.0, 3.0}, 0.0}, 12.0));
  EXPECT_FALSE(sampler.Next({{-5.0, 3.0}, 0.0}, 1.0));
}

TEST(GoalSamplerTest, LengthGoesAroundAndThroughWhatIsJustWideEnough) {
  OccupancyGrid grid = TwoRooms();
  for (int row = 40; row < 47; ++row) grid.At(80, row) = OccupancyGrid::kFree;
  for (int row = 1; row < 20; ++row) grid.At(80, row) = OccupancyGrid::kFree;
  GoalSampler sampler(grid, Footprint(), 1);
  const PlanarPose start{{7.0, 4.3}, 0.0};
  int beyond = 0;
  for (int k = 0; k < 100; ++k) {
    const auto goal = sampler.Next(start, 2.0);
    if (goal->pose.position.x() < 9.0 || goal->pose.position.y() < 4.0) continue;
    ++beyond;
    EXPECT_LT(goal->optimal_m, 1.15 * (goal->pose.position - start.position).norm() + 0.2);
  }
  EXPECT_GT(beyond, 5);
}

}  // namespace
}  // namespace hv::replay
