#pragma once

#include <vector>

#include "free_space.h"
#include "hv_navigation/path.h"

namespace hv::navigation {

struct RoundingRules {
  double radius_m = 0.6;  ///< of an arc at a corner, at most
  double step_m = 0.1;    ///< between poses
  bool keep_last_yaw = true;
};

/// The path that a chain of poses stands for, corners replaced by arcs where there is room. The
/// motions of the chain must be free.
Path Rounded(const FreeSpace& space, const std::vector<PlanarPose>& chain,
             const RoundingRules& rules);

}  // namespace hv::navigation
