#pragma once

#include <cstdlib>

#include <Eigen/Core>

namespace hv::explore {

/// Walks the cells of the straight line between two cells, each sharing an edge with the one before
/// (Bresenham without diagonal steps, as the public dungeon benchmark does). `visit(x, y)` is
/// called for every cell from `first` on, which is one of the line, except for the last one, `to`;
/// it returns false to stop.
template <typename Visit>
void WalkLine(const Eigen::Vector2i& from, const Eigen::Vector2i& to, const Eigen::Vector2i& first,
              Visit visit) {
  const int dx = std::abs(to.x() - from.x());
  const int dy = std::abs(to.y() - from.y());
  const int step_x = to.x() > from.x() ? 1 : -1;
  const int step_y = to.y() > from.y() ? 1 : -1;
  const int gone_x = std::abs(first.x() - from.x());
  const int gone_y = std::abs(first.y() - from.y());
  int x = first.x();
  int y = first.y();
  int error = dx - dy - 2 * dy * gone_x + 2 * dx * gone_y;
  for (int left = dx + dy - gone_x - gone_y; left > 0; --left) {
    if (!visit(x, y)) return;
    // Without branches: which way it goes next is hard to foretell.
    const bool across = error > 0;
    x += across ? step_x : 0;
    y += across ? 0 : step_y;
    error += across ? -2 * dy : 2 * dx;
  }
}

/// The whole line.
template <typename Visit>
void WalkLine(const Eigen::Vector2i& from, const Eigen::Vector2i& to, Visit visit) {
  WalkLine(from, to, from, visit);
}

}  // namespace hv::explore
