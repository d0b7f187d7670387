#pragma once

#include <cstdint>
#include <memory>

#include "hv_core/se3.h"
#include "hv_sim/robot_body.h"
#include "hv_sim/world.h"

namespace hv::sim {

/// A pose of the base on the floor, at any heading, where the robot stands free by 0.15 m of all
/// things and 1 m of all people at time 0: within sight of the route, at most 4 m beside it.
/// `scene` holds the triangles of the world. Throws InputError when none is found. The same for the
/// same seed.
Pose RandomStart(const World& world, const std::shared_ptr<const RayCaster>& scene,
                 const RobotBodyConfig& robot, std::uint32_t seed);

}  // namespace hv::sim
