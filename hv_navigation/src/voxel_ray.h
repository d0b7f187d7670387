#pragma once

#include <cmath>
#include <cstdlib>
#include <limits>

#include <Eigen/Core>

namespace hv::navigation {

/// Calls `visit(cell, enter, leave)` for each unit cell that the segment from `from` to `to` passes
/// but the last, in order; `enter` and `leave` are shares of its length (Amanatides and Woo, 1987).
/// Both ends must be finite and within int. Visits as many cells as the ends differ by, whatever
/// rounding does.
template <typename Visit>
void TraverseVoxels(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Visit& visit) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  Eigen::Vector3i cell = from.array().floor().cast<int>();
  const Eigen::Vector3i last = to.array().floor().cast<int>();
  const Eigen::Vector3d way = to - from;
  int direction[3];
  int remaining[3];
  double next[3];
  double delta[3];
  for (int axis = 0; axis < 3; ++axis) {
    remaining[axis] = std::abs(last[axis] - cell[axis]);
    direction[axis] = way[axis] > 0.0 ? 1 : -1;
    delta[axis] = 1.0 / std::abs(way[axis]);
    const double border = cell[axis] + (way[axis] > 0.0 ? 1.0 : 0.0);
    next[axis] = remaining[axis] > 0 ? (border - from[axis]) / way[axis] : kNever;
  }
  double enter = 0.0;
  for (int step = remaining[0] + remaining[1] + remaining[2]; step > 0; --step) {
    int axis = next[0] < next[1] ? 0 : 1;
    if (next[2] < next[axis]) axis = 2;
    const double leave = next[axis];
    visit(cell, enter, leave);
    enter = leave;
    cell[axis] += direction[axis];
    next[axis] = --remaining[axis] > 0 ? leave + delta[axis] : kNever;
  }
}

}  // namespace hv::navigation
