#include "hv_explore_sac/belief.h"

#include <stdexcept>

#include "hv_explore_sac/grid_line.h"

namespace hv::explore {
namespace {

Cell FromGrid(std::int8_t value) {
  if (value < 0) return Cell::kUnknown;
  return OccupancyGrid::IsOccupied(value) ? Cell::kOccupied : Cell::kFree;
}

}  // namespace

Belief::Belief(int width, int height, const Eigen::Vector2i& low)
    : width_(width),
      height_(height),
      low_(low),
      cells_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), Cell::kUnknown) {}

void Belief::Assign(const OccupancyGrid& grid) {
  if (grid.width != width_ || grid.height != height_) {
    throw std::invalid_argument("the grid and the belief differ in size");
  }
  int index = 0;
  for (const std::int8_t value : grid.cells) Set(index++, FromGrid(value));
}

int Belief::FirstBlocked(const Eigen::Vector2i& from, const Eigen::Vector2i& to, int first) const {
  int blocked = kNone;
  WalkLine(from, to, CellOf(first), [&](int x, int y) {
    const int index = IndexOf({x, y});
    if (At(index) == Cell::kFree) return true;
    blocked = index;
    return false;
  });
  return blocked;
}

void Belief::ClearChanges() {
  changes_.clear();
  lost_free_ = false;
}

void Belief::Change(int index, Cell cell) {
  Cell& stored = cells_[static_cast<std::size_t>(index)];
  changes_.push_back({index, stored, cell});
  lost_free_ |= stored == Cell::kFree;
  free_count_ += (cell == Cell::kFree) - (stored == Cell::kFree);
  stored = cell;
}

}  // namespace hv::explore
