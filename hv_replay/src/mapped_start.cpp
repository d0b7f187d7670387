#include "hv_replay/mapped_start.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "hv_core/error.h"
#include "hv_sim/start_pose.h"

namespace hv::replay {

sim::LiveConfig WithMappedStart(sim::LiveConfig simulation, const sim::World& world,
                                const Trajectory& mapped, const Pose& T_map_world) {
  constexpr int kTries = 100;
  constexpr std::uint32_t kNextSeed = 7919;
  constexpr double kMapped_m = 2.5;
  if (!simulation.start.empty()) return simulation;
  const auto scene = std::make_shared<const sim::RayCaster>(world.mesh);
  for (std::uint32_t i = 0; i < kTries; ++i) {
    const auto seed = static_cast<std::uint32_t>(simulation.seed) + i * kNextSeed;
    const Pose start = sim::RandomStart(world, scene, simulation.robot, seed);
    const Eigen::Vector3d in_map = T_map_world * start.translation();
    const bool is_mapped =
        std::any_of(mapped.poses().begin(), mapped.poses().end(), [&](const StampedPose& pose) {
          return (pose.pose.translation() - in_map).head<2>().norm() <= kMapped_m;
        });
    if (!is_mapped) continue;
    const double yaw = std::atan2(start.linear()(1, 0), start.linear()(0, 0));
    const Eigen::Vector3d at = start.translation();
    simulation.start = {at.x(), at.y(), at.z(), yaw * 180.0 / M_PI};
    return simulation;
  }
  throw InputError("world '" + world.name + "': the map holds no place for the robot to start");
}

}  // namespace hv::replay
