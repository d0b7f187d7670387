#pragma once

#include "hv_core/occupancy_grid.h"
#include "hv_core/se3.h"
#include "hv_navigation/mapping_config.h"
#include "hv_navigation/obstacle_map.h"

namespace hv::navigation {

/// The map seen from above, in a square of about `side_m` around the robot, with cells as large as
/// voxels, in the frame of odometry. Occupied where something stands between a step above the
/// ground and the top of the robot, where the ground drops, and where it is too steep. Free where
/// the ground is seen, or rays pass where the robot would be. An empty grid for a pose that is not
/// finite.
OccupancyGrid MakeObstacleGrid(const ObstacleMap& map, const GroundConfig& ground,
                               const ObstacleGridConfig& config, const Pose& T_odom_base,
                               double side_m);

}  // namespace hv::navigation
