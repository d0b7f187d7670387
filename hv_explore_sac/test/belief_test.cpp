#include "hv_explore_sac/belief.h"

#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "hv_explore_sac/grid_line.h"

namespace hv::explore {
namespace {

TEST(WalkLineTest, SharesEdgesFromFirstToBeforeLast) {
  for (const Eigen::Vector2i& to :
       {Eigen::Vector2i(7, 3), Eigen::Vector2i(-2, 9), Eigen::Vector2i(0, -5),
        Eigen::Vector2i(-4, -4), Eigen::Vector2i(6, 0), Eigen::Vector2i(0, 0)}) {
    std::vector<Eigen::Vector2i> cells;
    WalkLine({0, 0}, to, [&cells](int x, int y) {
      cells.emplace_back(x, y);
      return true;
    });
    ASSERT_EQ(static_cast<int>(cells.size()), to.cwiseAbs().sum());
    if (cells.empty()) continue;
    EXPECT_EQ(cells.front(), Eigen::Vector2i(0, 0));
    cells.push_back(to);
    for (std::size_t i = 1; i < cells.size(); ++i) {
      EXPECT_EQ((cells[i] - cells[i - 1]).cwiseAbs().sum(), 1);
      // Never farther than a cell from the line.
      const Eigen::Vector2d line = to.cast<double>().normalized();
      const Eigen::Vector2d cell = cells[i].cast<double>();
      EXPECT_LE(std::abs(line.x() * cell.y() - line.y() * cell.x()), 1.0);
    }
  }
}

TEST(WalkLineTest, GoesOnFromAnyOfItsCells) {
  const auto cells_from = [](const Eigen::Vector2i& to, const Eigen::Vector2i& first) {
    std::vector<Eigen::Vector2i> cells;
    WalkLine({3, -2}, to, first, [&cells](int x, int y) {
      cells.emplace_back(x, y);
      return true;
    });
    return cells;
  };
  for (const Eigen::Vector2i& to : {Eigen::Vector2i(12, 5), Eigen::Vector2i(-9, 4),
                                    Eigen::Vector2i(3, 8), Eigen::Vector2i(-5, -13)}) {
    const std::vector<Eigen::Vector2i> whole = cells_from(to, {3, -2});
    for (std::size_t i = 0; i < whole.size(); ++i) {
      const std::vector<Eigen::Vector2i> rest(whole.begin() + static_cast<std::ptrdiff_t>(i),
                                              whole.end());
      EXPECT_EQ(cells_from(to, whole[i]), rest);
    }
  }
}

TEST(BeliefTest, RemembersWhatChanged) {
  Belief belief(5, 4);
  belief.Set(7, Cell::kFree);
  belief.Set(7, Cell::kFree);
  belief.Set(8, Cell::kOccupied);
  ASSERT_EQ(belief.changes().size(), 2U);
  EXPECT_EQ(belief.changes()[0].before, Cell::kUnknown);
  EXPECT_EQ(belief.changes()[0].after, Cell::kFree);
  EXPECT_EQ(belief.free_count(), 1);
  EXPECT_FALSE(belief.lost_free());
  belief.ClearChanges();
  belief.Set(7, Cell::kOccupied);
  EXPECT_TRUE(belief.lost_free());
  EXPECT_EQ(belief.free_count(), 0);
}

TEST(BeliefTest, TakesOverAGridOfTheSameSize) {
  OccupancyGrid grid;
  grid.width = 3;
  grid.height = 2;
  grid.cells = {-1, 0, 100, 20, 60, -1};
  Belief belief(3, 2);
  belief.Assign(grid);
  EXPECT_EQ(belief.At(Eigen::Vector2i(1, 0)), Cell::kFree);
  EXPECT_EQ(belief.At(Eigen::Vector2i(2, 0)), Cell::kOccupied);
  EXPECT_EQ(belief.At(Eigen::Vector2i(0, 1)), Cell::kFree);
  EXPECT_EQ(belief.At(Eigen::Vector2i(1, 1)), Cell::kOccupied);
  EXPECT_EQ(belief.changes().size(), 4U);
  grid.height = 1;
  EXPECT_THROW(belief.Assign(grid), std::invalid_argument);
}

TEST(BeliefTest, LinesEndAtTheFirstCellThatIsNotFree) {
  Belief belief(9, 1);
  for (int cell = 0; cell < 9; ++cell) belief.Set(cell, Cell::kFree);
  EXPECT_EQ(belief.FirstBlocked({0, 0}, {8, 0}), Belief::kNone);
  belief.Set(5, Cell::kUnknown);
  EXPECT_EQ(belief.FirstBlocked({0, 0}, {8, 0}), 5);
  EXPECT_EQ(belief.FirstBlocked({0, 0}, {5, 0}), Belief::kNone);
}

TEST(BeliefTest, NamesCellsFromItsLowestOn) {
  const Eigen::Vector2i low(-3, 2);
  Belief belief(4, 5, low);
  EXPECT_EQ(belief.IndexOf(low), 0);
  for (int index = 0; index < 20; ++index) {
    EXPECT_EQ(belief.IndexOf(belief.CellOf(index)), index);
    EXPECT_TRUE(belief.Contains(belief.CellOf(index)));
  }
  EXPECT_FALSE(belief.Contains({-4, 3}));
  EXPECT_FALSE(belief.Contains({1, 3}));
  EXPECT_TRUE(belief.Contains({0, 6}));
  EXPECT_FALSE(belief.Contains({0, 7}));
}

}  // namespace
}  // namespace hv::explore
