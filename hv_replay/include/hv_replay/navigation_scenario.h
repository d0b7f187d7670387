#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hv_core/se3.h"
#include "hv_navigation/clearance_grid.h"
#include "hv_navigation/path.h"
#include "hv_sim/live_config.h"

namespace hv::replay {

/// What gets in the way of a robot that drives.
enum class NavigationScenario {
  kRandom,          ///< nothing but what the world holds
  kLowObstacles,    ///< a box 0.15 m high, so near that all rays of the LiDAR pass over it
  kBlockedCorridor  ///< a box from wall to wall, 3 m ahead
};

/// "random", "low_obstacles" or "blocked_corridor". Throws InputError otherwise.
NavigationScenario ParseScenario(const std::string& name);

/// A robot under way, as it truly is.
struct DriveSituation {
  const navigation::ClearanceGrid& map;  ///< without what is not always there
  Pose T_map_world = Pose::Identity();
  Pose T_world_base = Pose::Identity();
  navigation::Velocity velocity;
  const navigation::Path& plan;  ///< in the map
  double remaining_m = 0.0;      ///< of the plan
  double time_s = 0.0;           ///< of the simulation
};

/// The box that the scenario puts on the plan now; nullopt where it has no place: the robot is slow
/// or turns, the plan bends, there is no way around a low box, or no wall beside. Low boxes stay
/// for ever, those that block for a minute.
std::optional<sim::TimedBox> BoxAhead(NavigationScenario scenario, const DriveSituation& situation);

/// Whether a robot with `radius_m` around its origin gets along the plan, from the pose nearest to
/// it on, past the box.
bool LeadsPast(const navigation::Path& plan, const DriveSituation& situation,
               const sim::TimedBox& box, double radius_m);

}  // namespace hv::replay
