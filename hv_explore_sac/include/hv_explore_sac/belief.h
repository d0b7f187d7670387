#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "hv_core/occupancy_grid.h"

namespace hv::explore {

/// What is known of a cell.
enum class Cell : std::uint8_t { kUnknown, kFree, kOccupied };

/// What is known of a place: a grid of cells that remembers which of them changed since the changes
/// were last taken care of. Cells are named by coordinates, from `low` on, or by index, rows of
/// growing y, x fastest. A larger belief of the same place, with a lower `low`, names its cells by
/// the same coordinates. Not thread-safe.
class Belief {
 public:
  /// Every cell is unknown.
  Belief(int width, int height, const Eigen::Vector2i& low = Eigen::Vector2i::Zero());

  int width() const { return width_; }
  int height() const { return height_; }
  const Eigen::Vector2i& low() const { return low_; }  ///< the cell of index 0
  int free_count() const { return free_count_; }

  bool Contains(const Eigen::Vector2i& cell) const {
    const Eigen::Vector2i at = cell - low_;
    return at.x() >= 0 && at.y() >= 0 && at.x() < width_ && at.y() < height_;
  }
  int IndexOf(const Eigen::Vector2i& cell) const {
    return (cell.y() - low_.y()) * width_ + cell.x() - low_.x();
  }
  Eigen::Vector2i CellOf(int index) const {
    return {low_.x() + index % width_, low_.y() + index / width_};
  }
  Cell At(int index) const { return cells_[static_cast<std::size_t>(index)]; }
  Cell At(const Eigen::Vector2i& cell) const { return At(IndexOf(cell)); }

  void Set(int index, Cell cell) {
    if (At(index) != cell) Change(index, cell);
  }

  /// Takes over a grid of the same size. Throws std::invalid_argument when the sizes differ.
  void Assign(const OccupancyGrid& grid);

  /// The first cell of the line from `from` to `to`, without `to`, that is not known to be free;
  /// kNone when all are. Both ends must lie inside.
  static constexpr int kNone = -1;
  int FirstBlocked(const Eigen::Vector2i& from, const Eigen::Vector2i& to) const {
    return FirstBlocked(from, to, IndexOf(from));
  }
  /// The same where all cells of the line before one of them are known to be free.
  int FirstBlocked(const Eigen::Vector2i& from, const Eigen::Vector2i& to, int first) const;

  struct CellChange {
    int index;
    Cell before;
    Cell after;
  };
  /// In the order of the changes; a cell may occur more than once.
  const std::vector<CellChange>& changes() const { return changes_; }
  /// Whether one of them was free and is no more.
  bool lost_free() const { return lost_free_; }
  void ClearChanges();

 private:
  void Change(int index, Cell cell);

  int width_;
  int height_;
  Eigen::Vector2i low_;
  int free_count_ = 0;
  std::vector<Cell> cells_;
  std::vector<CellChange> changes_;
  bool lost_free_ = false;
};

}  // namespace hv::explore
