#pragma once

#include <vector>

#include <Eigen/Core>

#include "hv_core/occupancy_grid.h"
#include "hv_core/se3.h"
#include "hv_sim/collision_checker.h"
#include "hv_sim/world.h"

namespace hv::replay {

/// The ground of a simulated world that a robot can get to: places 0.2 m apart where the largest
/// circle in its footprint stands free, joined by steps of that length. Doors are open, and people
/// are not minded.
class ReachableGround {
 public:
  /// `shape`: of the robot with what it keeps free around itself. At first it stands at
  /// `T_world_base`.
  ReachableGround(const sim::World& world, const sim::RobotShape& shape, const Pose& T_world_base);

  double area_m2() const;

  /// Share of it that a map shows as free, 0 to 1.
  double ShareKnown(const OccupancyGrid& map, const Pose& T_map_world) const;

 private:
  std::vector<Eigen::Vector3d> places_;  ///< on the floor, in the world [m]
};

}  // namespace hv::replay
