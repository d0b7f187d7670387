#include "hv_navigation/grid_search.h"

#include <gtest/gtest.h>

#include "grids.h"

namespace hv::navigation {
namespace {

class Search : public testing::TestWithParam<unsigned> {};

TEST_P(Search, IsAsShortAsDijkstra) {
  const double clearance_m = 0.15;
  const ClearanceGrid grid(RandomCells(60, 50, 0.05, GetParam()), ClearanceGrid::Unknown::kOccupied,
                           2.0);
  const auto open = [&](const Eigen::Vector2i& cell) {
    return grid.ClearanceAt(cell) >= clearance_m ? 1.0 : 0.0;
  };
  const Eigen::Vector2i start = OpenCell(grid, clearance_m, GetParam());
  const std::vector<double> truth = DijkstraLengths(grid, clearance_m, start);
  GridSearch search(grid);
  int found = 0;
  for (unsigned i = 0; i < 20; ++i) {
    const Eigen::Vector2i goal = OpenCell(grid, clearance_m, 1000 + 37 * i + GetParam());
    const double expected = truth[CellIndex(grid, goal)];
    ASSERT_EQ(search.Run(start, goal, open), std::isfinite(expected));
    if (!std::isfinite(expected)) continue;
    ++found;
    const std::vector<Eigen::Vector2i> route = search.RouteTo(goal);
    EXPECT_EQ(route.front(), start);
    EXPECT_EQ(route.back(), goal);
    // The whole numbers of the search are 0.005 % off the root of two.
    EXPECT_NEAR(RouteLength(route, grid.grid().resolution_m), expected, 1e-3 * expected + 1e-9);
    for (const Eigen::Vector2i& cell : route) EXPECT_GE(grid.ClearanceAt(cell), clearance_m);
  }
  EXPECT_GT(found, 0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Search, testing::Range(1U, 11U));

TEST(GridSearchTest, ReachesAllThatIsConnectedWhenThereIsNoWay) {
  OccupancyGrid cells = EmptyCells(40, 20, 0.1);
  FillCells(cells, {1.8, 0.0}, {2.2, 2.0});
  const ClearanceGrid grid(cells, ClearanceGrid::Unknown::kOccupied, 2.0);
  GridSearch search(grid);
  EXPECT_FALSE(search.Run({2, 2}, {35, 10}, [&](const Eigen::Vector2i& cell) {
    return grid.ClearanceAt(cell) > 0.0 ? 1.0 : 0.0;
  }));
  EXPECT_TRUE(search.Reached({17, 19}));
  EXPECT_FALSE(search.Reached({35, 10}));
}

TEST(GridSearchTest, AvoidsWhatCostsMore) {
  const ClearanceGrid grid(EmptyCells(30, 30, 0.1), ClearanceGrid::Unknown::kOccupied, 2.0);
  GridSearch search(grid);
  const auto factor = [](const Eigen::Vector2i& cell) { return cell.y() < 20 ? 6.0 : 1.0; };
  ASSERT_TRUE(search.Run({0, 18}, {29, 18}, factor));
  int dear = 0;
  for (const Eigen::Vector2i& cell : search.RouteTo({29, 18})) dear += cell.y() < 20;
  EXPECT_LE(dear, 6);
}

}  // namespace
}  // namespace hv::navigation
