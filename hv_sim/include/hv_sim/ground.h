#pragma once

#include <optional>

#include "hv_core/se3.h"
#include "hv_sim/ray_caster.h"

namespace hv::sim {

/// Height of the first surface below `from`, at most `reach_m` [m] down; nothing when there is
/// none.
std::optional<double> FloorBelow(const RayCaster& scene, const Eigen::Vector3d& from,
                                 double reach_m);

/// Distances between the wheels of a car-like base, whose origin is in their middle.
struct WheelLayout {
  double wheel_base_m = 0.40;  ///< front to back
  double track_m = 0.40;       ///< left to right
};

/// The base put down with its four wheels on the floor, near where `T_world_base` has it: height,
/// roll and pitch follow the floor, taken as the mean over the tyre's length. Nothing when a wheel
/// finds no floor between 0.25 m above and 0.15 m below.
std::optional<Pose> OnGround(const RayCaster& scene, const WheelLayout& wheels,
                             const Pose& T_world_base);

}  // namespace hv::sim
