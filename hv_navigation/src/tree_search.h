#pragma once

#include <vector>

#include "free_space.h"
#include "hv_navigation/global_planner.h"

namespace hv::navigation {

/// A chain of poses between each two of which the robot turns, drives straight ahead and turns.
struct PoseChain {
  std::vector<PlanarPose> poses;  ///< empty when none was found
  double cost = 0.0;
};

/// RRT* over poses around `guide`, a chain from start to goal that need not be free; then
/// shortcuts. Deterministic for a seed.
PoseChain SearchTree(const FreeSpace& space, const std::vector<PlanarPose>& guide,
                     const GlobalPlannerConfig& config);

}  // namespace hv::navigation
