#pragma once

#include <optional>
#include <vector>

#include "hv_core/occupancy_grid.h"

namespace hv::navigation {

/// Cells of a grid, both corners included.
struct CellBox {
  Eigen::Vector2i low;
  Eigen::Vector2i high;
};

/// The least box that holds a cell too.
inline void Include(const Eigen::Vector2i& cell, std::optional<CellBox>& box) {
  if (!box) box = CellBox{cell, cell};
  box->low = box->low.cwiseMin(cell);
  box->high = box->high.cwiseMax(cell);
}

/// A grid of obstacles with the distance to the nearest one for each cell. Places outside count as
/// unknown. Immutable; const methods may run concurrently.
class ClearanceGrid {
 public:
  enum class Unknown { kFree, kOccupied };

  /// `unknown`: what unknown cells count as. Distances are exact to 2 % and never above `limit_m`.
  ClearanceGrid(OccupancyGrid grid, Unknown unknown, double limit_m);

  /// The same with `cells`, which must lie inside, occupied too.
  ClearanceGrid WithObstacles(const std::vector<Eigen::Vector2i>& cells) const;

  /// The same with other cells: `grid` has the same size and place and differs only in `changed`.
  ClearanceGrid WithCells(OccupancyGrid grid, const CellBox& changed) const;

  const OccupancyGrid& grid() const { return grid_; }

  /// The cell that holds `position`, which may lie outside of the grid.
  Eigen::Vector2i CellOf(const Eigen::Vector2d& position) const { return grid_.CellOf(position); }
  Eigen::Vector2d CenterOf(const Eigen::Vector2i& cell) const { return grid_.CenterOf(cell); }
  bool Contains(const Eigen::Vector2i& cell) const { return grid_.Contains(cell); }

  /// From the centre of the cell of `position` to the nearest border of an obstacle [m]; 0 in
  /// obstacles, and outside of the grid when unknown places are obstacles.
  double ClearanceAt(const Eigen::Vector2d& position) const {
    const Eigen::Vector2d cell = (position - grid_.origin) * cells_per_m_;
    const bool inside =
        cell.x() >= 0.0 && cell.y() >= 0.0 && cell.x() < grid_.width && cell.y() < grid_.height;
    return inside ? ClearanceInside(static_cast<int>(cell.x()), static_cast<int>(cell.y()))
                  : outside_m_;
  }
  double ClearanceAt(const Eigen::Vector2i& cell) const {
    return Contains(cell) ? ClearanceInside(cell.x(), cell.y()) : outside_m_;
  }

  bool OccupiedAt(const Eigen::Vector2d& position) const { return ClearanceAt(position) <= 0.0; }

 private:
  double ClearanceInside(int column, int row) const {
    return static_cast<double>(clearance_m_[IndexOf(column, row)]);
  }
  std::size_t IndexOf(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.width) +
           static_cast<std::size_t>(column);
  }

  int ReachInCells() const;
  void Measure(const CellBox& box);

  OccupancyGrid grid_;
  Unknown unknown_;
  double cells_per_m_;
  double outside_m_;
  double limit_m_;
  std::vector<float> clearance_m_;
};

}  // namespace hv::navigation
