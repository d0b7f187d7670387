#pragma once

#include <limits>
#include <vector>

#include "free_space.h"

namespace hv::navigation {

struct LatticeRules {
  int expansions = 200000;
  double turn_cost_m = 0.15;                                 ///< of a radian
  double reach_m = std::numeric_limits<double>::infinity();  ///< no farther from the goal
};

/// A* over places and sixteen headings with the exact footprint: finds ways where the robot must
/// mind how it stands, at a price. A chain of poses from `start` to `goal`; empty when there is
/// none, or none within the number of expansions.
std::vector<PlanarPose> SearchLattice(const FreeSpace& space, const PlanarPose& start,
                                      const PlanarPose& goal, const LatticeRules& rules);

}  // namespace hv::navigation
