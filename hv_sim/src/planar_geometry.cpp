#include "planar_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hv::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double SegmentDistance(const Vector2d& point, const Vector2d& from, const Vector2d& to) {
  const Vector2d along = to - from;
  const double length2 = along.squaredNorm();
  const double share =
      length2 > 0.0 ? std::clamp(along.dot(point - from) / length2, 0.0, 1.0) : 0.0;
  return (point - from - share * along).norm();
}

/// Whether any part of the segment lies in the rectangle (Liang-Barsky).
bool Crosses(const Rectangle& rectangle, const Vector2d& from, const Vector2d& to) {
  double enter = 0.0;
  double leave = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double step = to[axis] - from[axis];
    if (step == 0.0) {
      if (from[axis] < rectangle.low[axis] || from[axis] > rectangle.high[axis]) return false;
      continue;
    }
    const double a = (rectangle.low[axis] - from[axis]) / step;
    const double b = (rectangle.high[axis] - from[axis]) / step;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave;
}

double Cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// A flat polygon contains nothing.
bool Contains(const std::vector<Vector2d>& polygon, const Vector2d& point) {
  bool left = false;
  bool right = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& from = polygon[i];
    const double side = Cross(polygon[(i + 1) % polygon.size()] - from, point - from);
    left = left || side > 0.0;
    right = right || side < 0.0;
  }
  return left != right;
}

/// What remains of a polygon where sign * (z - level) >= 0 (Sutherland-Hodgman).
std::vector<Vector3d> Clipped(const std::vector<Vector3d>& polygon, double level, double sign) {
  std::vector<Vector3d> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d& a = polygon[i];
    const Vector3d& b = polygon[(i + 1) % polygon.size()];
    const double height_a = sign * (a.z() - level);
    const double height_b = sign * (b.z() - level);
    if (height_a >= 0.0) kept.push_back(a);
    if (height_a * height_b < 0.0) kept.push_back(a + height_a / (height_a - height_b) * (b - a));
  }
  return kept;
}

}  // namespace

double Rectangle::DistanceTo(const Vector2d& point) const {
  return (point - point.cwiseMax(low).cwiseMin(high)).norm();
}

double Distance(const Rectangle& rectangle, const Vector2d& from, const Vector2d& to) {
  if (Crosses(rectangle, from, to)) return 0.0;
  const Vector2d& low = rectangle.low;
  const Vector2d& high = rectangle.high;
  return std::min({rectangle.DistanceTo(from), rectangle.DistanceTo(to),
                   SegmentDistance(low, from, to), SegmentDistance(high, from, to),
                   SegmentDistance({low.x(), high.y()}, from, to),
                   SegmentDistance({high.x(), low.y()}, from, to)});
}

double Distance(const Rectangle& rectangle, const std::vector<Vector2d>& polygon) {
  if (polygon.size() > 2 && Contains(polygon, rectangle.low)) return 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size() && least > 0.0; ++i) {
    least = std::min(least, Distance(rectangle, polygon[i], polygon[(i + 1) % polygon.size()]));
  }
  return least;
}

std::vector<Vector2d> SliceOf(const std::array<Vector3d, 3>& triangle, double low, double high) {
  std::vector<Vector3d> part(triangle.begin(), triangle.end());
  part = Clipped(Clipped(part, low, 1.0), high, -1.0);
  std::vector<Vector2d> seen;
  seen.reserve(part.size());
  for (const Vector3d& corner : part) seen.emplace_back(corner.head<2>());
  return seen;
}

}  // namespace hv::sim
