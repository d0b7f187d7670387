#include "hv_navigation/clearance_grid.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace hv::navigation {
namespace {

OccupancyGrid Random(int width, int height, double occupied, double unknown, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform;
  OccupancyGrid grid;
  grid.resolution_m = 0.1;
  grid.origin = {-1.0, 2.0};
  grid.width = width;
  grid.height = height;
  for (int i = 0; i < width * height; ++i) {
    const double draw = uniform(random);
    grid.cells.push_back(draw < occupied             ? OccupancyGrid::kOccupied
                         : draw < occupied + unknown ? OccupancyGrid::kUnknown
                                                     : OccupancyGrid::kFree);
  }
  return grid;
}

class Clearance : public testing::TestWithParam<ClearanceGrid::Unknown> {};

TEST_P(Clearance, IsTheDistanceToTheNearestObstacle) {
  const OccupancyGrid cells = Random(40, 30, 0.01, 0.01, 5);
  const double limit_m = 0.8;
  const ClearanceGrid grid(cells, GetParam(), limit_m);
  for (int row = 0; row < cells.height; ++row) {
    for (int column = 0; column < cells.width; ++column) {
      double nearest = 1e9;
      for (int y = 0; y < cells.height; ++y) {
        for (int x = 0; x < cells.width; ++x) {
          const bool obstacle = cells.At(x, y) == OccupancyGrid::kOccupied ||
                                (cells.At(x, y) == OccupancyGrid::kUnknown &&
                                 GetParam() == ClearanceGrid::Unknown::kOccupied);
          if (obstacle) nearest = std::min(nearest, std::hypot(x - column, y - row));
        }
      }
      const double expected = std::min(limit_m, 0.1 * std::max(0.0, nearest - 0.5));
      EXPECT_NEAR(grid.ClearanceAt(Eigen::Vector2i(column, row)), expected, 0.02 * expected + 1e-6);
    }
  }
}

TEST_P(Clearance, OfAddedObstaclesIsThatOfAll) {
  const OccupancyGrid cells = Random(60, 50, 0.005, 0.005, 6);
  std::mt19937 random(8);
  std::uniform_int_distribution<int> column(5, 40);
  std::uniform_int_distribution<int> row(30, 49);
  std::vector<Eigen::Vector2i> added;
  OccupancyGrid all = cells;
  for (int i = 0; i < 10; ++i) {
    added.emplace_back(column(random), row(random));
    all.At(added.back().x(), added.back().y()) = OccupancyGrid::kOccupied;
  }
  const ClearanceGrid truth(all, GetParam(), 0.8);
  const ClearanceGrid grid = ClearanceGrid(cells, GetParam(), 0.8).WithObstacles(added);
  for (int y = 0; y < cells.height; ++y) {
    for (int x = 0; x < cells.width; ++x) {
      const Eigen::Vector2i cell(x, y);
      EXPECT_NEAR(grid.ClearanceAt(cell), truth.ClearanceAt(cell), 0.01);
      EXPECT_EQ(grid.grid().At(x, y), all.At(x, y));
    }
  }
}

TEST_P(Clearance, OfChangedCellsIsThatOfAll) {
  constexpr double kLimit_m = 0.8;
  OccupancyGrid cells = Random(60, 50, 0.01, 0.005, 6);
  const ClearanceGrid before(cells, GetParam(), kLimit_m);
  for (const CellBox& box : {CellBox{{20, 10}, {31, 24}}, CellBox{{0, 45}, {3, 49}}}) {
    OccupancyGrid changed = cells;
    for (int y = box.low.y(); y <= box.high.y(); ++y) {
      for (int x = box.low.x(); x <= box.high.x(); ++x) {
        const bool occupied = (x * 7 + y * 13) % 29 == 0;
        changed.At(x, y) = occupied ? OccupancyGrid::kOccupied : OccupancyGrid::kFree;
      }
    }
    const ClearanceGrid truth(changed, GetParam(), kLimit_m);
    const ClearanceGrid grid = before.WithCells(changed, box);
    EXPECT_EQ(grid.grid().cells, changed.cells);
    for (int y = 0; y < cells.height; ++y) {
      for (int x = 0; x < cells.width; ++x) {
        EXPECT_EQ(grid.ClearanceAt(Eigen::Vector2i(x, y)), truth.ClearanceAt(Eigen::Vector2i(x, y)))
            << x << " " << y;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Unknown, Clearance,
                         testing::Values(ClearanceGrid::Unknown::kFree,
                                         ClearanceGrid::Unknown::kOccupied));

TEST(ClearanceGridTest, CellsAndPlaces) {
  const ClearanceGrid grid(Random(10, 20, 0.0, 0.0, 1), ClearanceGrid::Unknown::kFree, 1.0);
  for (const Eigen::Vector2i& cell : {Eigen::Vector2i(0, 0), Eigen::Vector2i(9, 19)}) {
    EXPECT_EQ(grid.CellOf(grid.CenterOf(cell)), cell);
    EXPECT_TRUE(grid.Contains(cell));
  }
  EXPECT_EQ(grid.CellOf({-1.01, 2.01}), Eigen::Vector2i(-1, 0));
  EXPECT_FALSE(grid.Contains({-1, 0}));
  EXPECT_FALSE(grid.Contains({10, 0}));
  EXPECT_FALSE(grid.Contains(grid.CellOf({1e30, -1e30})));
}

TEST(ClearanceGridTest, OutsideIsUnknown) {
  const OccupancyGrid cells = Random(10, 10, 0.0, 0.0, 1);
  const Eigen::Vector2d outside(50.0, 50.0);
  EXPECT_EQ(ClearanceGrid(cells, ClearanceGrid::Unknown::kFree, 1.0).ClearanceAt(outside), 1.0);
  EXPECT_EQ(ClearanceGrid(cells, ClearanceGrid::Unknown::kOccupied, 1.0).ClearanceAt(outside), 0.0);
  EXPECT_EQ(ClearanceGrid({}, ClearanceGrid::Unknown::kOccupied, 1.0).ClearanceAt(outside), 0.0);
}

}  // namespace
}  // namespace hv::navigation
