#pragma once

#include <cstdlib>

#include <Eigen/Core>

namespace hv::explore {

/// Walks the cells of a straight line, each sharing an edge with the one before (Bresenham without
/// diagonal steps, as the public dungeon benchmark does). `visit(x, y)` is called for every cell
/// from `from` on, except for the last one, `to`; it returns false to stop.
template <typename Visit>
void WalkLine(const Eigen::Vector2i& from, const Eigen::Vector2i& to, Visit visit) {
  const int dx = std::abs(to.x() - from.x());
  const int dy = std::abs(to.y() - from.y());
  const int step_x = to.x() > from.x() ? 1 : -1;
  const int step_y = to.y() > from.y() ? 1 : -1;
  int x = from.x();
  int y = from.y();
  int error = dx - dy;
  for (int left = dx + dy; left > 0; --left) {
    if (!visit(x, y)) return;
    if (error > 0) {
      x += step_x;
      error -= 2 * dy;
    } else {
      y += step_y;
      error += 2 * dx;
    }
  }
}

}  // namespace hv::explore
