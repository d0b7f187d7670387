#pragma once

#include <vector>

#include "hv_core/occupancy_grid.h"

namespace hv::navigation {

/// A grid of obstacles with the distance to the nearest one for each cell. Places outside count as
/// unknown. Immutable; const methods may run concurrently.
class ClearanceGrid {
 public:
  enum class Unknown { kFree, kOccupied };

  /// `unknown`: what unknown cells count as. Distances are exact to 2 % and never above `limit_m`.
  ClearanceGrid(OccupancyGrid grid, Unknown unknown, double limit_m);

  const OccupancyGrid& grid() const { return grid_; }

  /// The cell that holds `position`, which may lie outside of the grid.
  Eigen::Vector2i CellOf(const Eigen::Vector2d& position) const;
  Eigen::Vector2d CenterOf(const Eigen::Vector2i& cell) const;
  bool Contains(const Eigen::Vector2i& cell) const;

  /// From the centre of the cell of `position` to the nearest border of an obstacle [m]; 0 in
  /// obstacles, and outside of the grid when unknown places are obstacles.
  double ClearanceAt(const Eigen::Vector2d& position) const {
    return ClearanceAt(CellOf(position));
  }
  double ClearanceAt(const Eigen::Vector2i& cell) const;

  bool OccupiedAt(const Eigen::Vector2d& position) const { return ClearanceAt(position) <= 0.0; }

 private:
  OccupancyGrid grid_;
  double outside_m_;
  std::vector<float> clearance_m_;
};

}  // namespace hv::navigation
