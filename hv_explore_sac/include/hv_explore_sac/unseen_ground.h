#pragma once

#include <Eigen/Core>

#include "hv_explore_sac/belief.h"

namespace hv::explore {

/// Closes what is unknown and of no interest to a robot: unknown cells of `belief` become occupied
/// that lie more than `reach` [cells] away from all unseen ground. Unseen ground are the unknown
/// cells of `ground` that the robot may be able to get to from `robot`, if all that is unknown were
/// free; what lies beyond both beliefs, which have the same cells, is unknown too.
void CloseAllBut(const Belief& ground, const Eigen::Vector2i& robot, double reach, Belief& belief);

}  // namespace hv::explore
