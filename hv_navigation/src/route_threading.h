#pragma once

#include <vector>

#include "free_space.h"
#include "heading_lattice.h"
#include "route_finder.h"

namespace hv::navigation {

/// A route over cells as the robot can drive it.
struct ThreadedRoute {
  std::vector<PlanarPose> poses;  ///< from start to goal; empty where it does not get through
  Route stuck;                    ///< then, the stretch of the route that is too narrow
};

/// Follows a route from the cell of `start` to that of `goal` with the exact footprint: from place
/// to place where the robot can turn, and by a search over headings through what lies between
/// where it cannot. `rules` are those of a single such search.
ThreadedRoute ThreadRoute(const FreeSpace& space, const PlanarPose& start, const PlanarPose& goal,
                          const Route& route, const LatticeRules& rules);

}  // namespace hv::navigation
