#include "hv_navigation/obstacle_grid.h"

#include <algorithm>

#include "hv_navigation/ground_model.h"
#include "hv_navigation/surface_columns.h"

namespace hv::navigation {
namespace {

/// Whether a surface lies between two heights.
bool IsObstructed(const SurfaceColumns::Column& column, double low_m, double high_m) {
  return std::any_of(column.begin(), column.end(), [&](const SurfaceColumns::Surface& surface) {
    return static_cast<double>(surface.high) > low_m && static_cast<double>(surface.low) < high_m;
  });
}

}  // namespace

OccupancyGrid MakeObstacleGrid(const ObstacleMap& map, const GroundConfig& ground,
                               const ObstacleGridConfig& config, const Pose& T_odom_base,
                               double side_m) {
  OccupancyGrid grid;
  grid.resolution_m = map.voxel_m();
  if (!T_odom_base.matrix().allFinite()) return grid;
  const SurfaceColumns columns(map, T_odom_base.translation(), side_m);
  const GroundModel model(columns, ground, T_odom_base);
  grid.origin = columns.origin();
  grid.width = grid.height = columns.side();
  const auto cells = static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height);
  grid.cells.assign(cells, OccupancyGrid::kUnknown);
  for (std::size_t i = 0; i < cells; ++i) {
    const Ground kind = model.KindAt(i);
    const double low_m = model.ReferenceAt(i) + ground.max_step_m;
    const double high_m = model.HeightAt(i) + config.robot_height_m + config.height_margin_m;
    if (kind == Ground::kDrop || kind == Ground::kSlope || kind == Ground::kStep ||
        IsObstructed(columns.At(i), low_m, high_m)) {
      grid.cells[i] = OccupancyGrid::kOccupied;
    } else if (kind == Ground::kSeen ||
               (kind == Ground::kAssumed && columns.FreeBetween(i, low_m, high_m))) {
      grid.cells[i] = OccupancyGrid::kFree;
    }
  }
  return grid;
}

}  // namespace hv::navigation
