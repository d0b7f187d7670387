#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "hv_core/se3.h"
#include "hv_sim/world.h"

namespace hv::sim {

struct ViewLimits {
  double beside_route_m = 4.0;  ///< how far beside the route
  double clearance_m = 0.45;    ///< to everything static
  double least_height_m = 0.6;  ///< above the floor
  double most_height_m = 1.4;
  double tilt_deg = 3.0;     ///< roll and pitch, at most
  double keep_away_m = 0.7;  ///< from the places to avoid
};

/// Poses that a LiDAR could stand at in a world: within sight of its route, beside it, clear of
/// everything, at any heading; none near one of the places `avoid` [m]. Fewer than `count` when the
/// world has no room for more. The same for the same seed.
std::vector<Pose> SampleViews(const World& world, int count, const ViewLimits& limits,
                              const std::vector<Eigen::Vector3d>& avoid, std::uint32_t seed);

}  // namespace hv::sim
