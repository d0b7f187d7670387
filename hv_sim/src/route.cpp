#include "hv_sim/route.h"

#include <algorithm>
#include <cmath>

namespace hv::sim {
namespace {

using Eigen::Vector3d;

void AppendSegment(const Vector3d& to, double step, std::vector<Vector3d>& points) {
  const Vector3d from = points.back();
  const int pieces = std::max(1, static_cast<int>(std::ceil((to - from).norm() / step)));
  for (int i = 1; i <= pieces; ++i) points.emplace_back(from + (to - from) * i / pieces);
}

/// Replaces the corner at `at` by an arc; `points` is empty or ends before the corner.
void AppendCorner(const Vector3d& previous, const Vector3d& at, const Vector3d& next, double radius,
                  double step, std::vector<Vector3d>& points) {
  const Vector3d in = (at - previous).normalized();
  const Vector3d out = (next - at).normalized();
  const double turn = std::acos(std::clamp(in.dot(out), -1.0, 1.0));
  const double reach = 0.5 * std::min((at - previous).norm(), (next - at).norm());
  const double tangent = std::min(radius * std::tan(0.5 * turn), reach);
  const Vector3d first = at - tangent * in;
  if (points.empty()) {
    points.push_back(first);
  } else {
    AppendSegment(first, step, points);
  }
  constexpr double kStraight = 1e-3;  // [rad], also for reversals
  if (tangent <= 0.0 || turn < kStraight || turn > M_PI - kStraight) {
    AppendSegment(at, step, points);
    return;
  }
  const double arc_radius = tangent / std::tan(0.5 * turn);
  const Vector3d side = (out - in.dot(out) * in).normalized();
  const int pieces = std::max(2, static_cast<int>(std::ceil(arc_radius * turn / step)));
  for (int i = 1; i <= pieces; ++i) {
    const double angle = turn * i / pieces;
    points.emplace_back(first +
                        arc_radius * (std::sin(angle) * in + (1.0 - std::cos(angle)) * side));
  }
}

}  // namespace

std::vector<Vector3d> SampleRoute(const std::vector<Vector3d>& route, bool closed, double radius,
                                  double step) {
  std::vector<Vector3d> points;
  const std::size_t count = route.size();
  if (count < 2) return route;
  for (std::size_t i = 0; i < count; ++i) {
    const bool end = !closed && (i == 0 || i + 1 == count);
    if (!end) {
      AppendCorner(route[(i + count - 1) % count], route[i], route[(i + 1) % count], radius, step,
                   points);
    } else if (points.empty()) {
      points.push_back(route[i]);
    } else {
      AppendSegment(route[i], step, points);
    }
  }
  if (closed) AppendSegment(Vector3d(points.front()), step, points);
  return points;
}

}  // namespace hv::sim
