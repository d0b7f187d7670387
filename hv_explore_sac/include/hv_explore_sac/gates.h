#pragma once

#include <Eigen/Core>

#include "hv_explore_sac/belief.h"

namespace hv::explore {

/// Which part of the border of the known a robot may drive on from.
struct GateRules {
  double least_cells = 0.0;  ///< of unseen ground joined to each other; fewer need not be seen
  double around = 0.0;  ///< what is unknown so near to a gate stays so: the robot's room [cells]
  double beyond = 0.0;  ///< of what is free, where unknown cells make no frontier [cells]
};

/// Closes views of what the robot cannot get to, or which is too little. A gate is an unknown cell
/// of `ground` beside ground that is known to be free and joined to where the robot is, by steps to
/// the four sides; beyond both beliefs, which have the same cells, all is unknown. Unknown cells of
/// `belief` far from all gates and near to free ones become occupied, so that no frontiers are left
/// but those at gates.
void CloseBesideGates(const Belief& ground, const Eigen::Vector2i& robot, const GateRules& rules,
                      Belief& belief);

}  // namespace hv::explore
