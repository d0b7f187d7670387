#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "hv_sim/ray_caster.h"
#include "hv_sim/world.h"

namespace hv::sim {

/// A cylinder of `radius` with round ends.
struct Capsule {
  Eigen::Vector3f from = Eigen::Vector3f::Zero();
  Eigen::Vector3f to = Eigen::Vector3f::Zero();
  float radius = 0.1F;
};

/// A walking person at one instant: torso, head, and limbs that swing with the step.
struct Pedestrian {
  Eigen::Vector3f center = Eigen::Vector3f::Zero();  ///< of the bounding sphere
  std::array<Capsule, 6> parts;
};

inline constexpr float kPedestrianRadius = 1.0F;  ///< of the bounding sphere [m]

/// Feet of the walker at `time_s`, on the floor.
Eigen::Vector3d FeetAt(const PersonPath& path, double time_s);

Pedestrian PedestrianAt(const PersonPath& path, double time_s);

/// Shortens `hit` to the person when the ray meets the person first.
void Intersect(const Pedestrian& person, const Ray& ray, Hit& hit);

}  // namespace hv::sim
