#include "motion_path.h"

#include <algorithm>
#include <cmath>

#include "hv_core/error.h"

namespace hv::sim {
namespace {

using Polyline = std::vector<Eigen::Vector3d>;

/// A corner sharper than this is a reversal: stop and turn on the spot.
const double kReversalCosine = std::cos(150.0 * M_PI / 180.0);

double Length(const Polyline& line) {
  double length = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  return length;
}

/// One period of the route: a lap that ends where it began, or the way there and back.
Polyline Period(const World& world) {
  Polyline line;
  for (const Eigen::Vector3d& waypoint : world.route) {
    if (line.empty() || (waypoint - line.back()).norm() > 1e-3) line.push_back(waypoint);
  }
  if (line.size() < 2) throw InputError("world '" + world.name + "': its route has no length");
  if (world.closed) {
    if ((line.front() - line.back()).norm() > 1e-3) line.push_back(line.front());
  } else {
    line.insert(line.end(), line.rbegin() + 1, line.rend());
  }
  return line;
}

Polyline Unroll(const World& world, double length) {
  const Polyline period = Period(world);
  const auto laps = static_cast<int>(std::ceil(length / Length(period)));
  Polyline line = period;
  for (int lap = 1; lap < laps; ++lap) {
    line.insert(line.end(), period.begin() + 1, period.end());
  }
  return line;
}

Eigen::Vector3d Direction(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return (to - from).normalized();
}

std::vector<Polyline> SplitAtReversals(const Polyline& line) {
  std::vector<Polyline> parts{{line.front()}};
  for (std::size_t i = 1; i < line.size(); ++i) {
    parts.back().push_back(line[i]);
    if (i + 1 == line.size()) break;
    const double cosine = Direction(line[i - 1], line[i]).dot(Direction(line[i], line[i + 1]));
    if (cosine < kReversalCosine) parts.push_back({line[i]});
  }
  return parts;
}

/// Replaces each corner by a parabola that starts and ends at most `corner` before and after it.
Polyline RoundCorners(const Polyline& line, double corner) {
  constexpr int kPieces = 24;
  Polyline rounded{line.front()};
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    const double reach = std::min({corner, 0.5 * (line[i] - line[i - 1]).norm(),
                                   0.5 * (line[i + 1] - line[i]).norm()});
    const Eigen::Vector3d begin = line[i] - reach * Direction(line[i - 1], line[i]);
    const Eigen::Vector3d end = line[i] + reach * Direction(line[i], line[i + 1]);
    for (int k = 0; k <= kPieces; ++k) {
      const double u = static_cast<double>(k) / kPieces;
      rounded.push_back((1 - u) * (1 - u) * begin + 2 * u * (1 - u) * line[i] + u * u * end);
    }
  }
  rounded.push_back(line.back());
  return rounded;
}

Polyline Resample(const Polyline& line) {
  Polyline points{line.front()};
  double left = PathRun::kSpacing;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double length = (line[i] - line[i - 1]).norm();
    double at = left;
    for (; at <= length; at += PathRun::kSpacing) {
      points.push_back(line[i - 1] + at / length * (line[i] - line[i - 1]));
    }
    left = at - length;
  }
  return points;
}

void DescribeShape(PathRun& run) {
  const std::size_t count = run.points.size();
  run.yaw.resize(count);
  run.slope.resize(count);
  run.curvature.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1;
    const std::size_t after = std::min(i + 1, count - 1);
    const Eigen::Vector3d chord = run.points[after] - run.points[before];
    const double yaw = std::atan2(chord.y(), chord.x());
    run.yaw[i] = i == 0 ? yaw : run.yaw[i - 1] + std::remainder(yaw - run.yaw[i - 1], 2.0 * M_PI);
    run.slope[i] = chord.z() / std::max(chord.norm(), 1e-9);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t before = i < 2 ? 0 : i - 2;
    const std::size_t after = std::min(i + 2, count - 1);
    const double length = PathRun::kSpacing * static_cast<double>(after - before);
    run.curvature[i] = (run.yaw[after] - run.yaw[before]) / length;
  }
}

}  // namespace

std::vector<PathRun> MakePath(const World& world, double length, double corner) {
  std::vector<PathRun> runs;
  for (const Polyline& part : SplitAtReversals(Unroll(world, length))) {
    PathRun run;
    run.points = Resample(RoundCorners(part, corner));
    if (run.points.size() < 2) continue;
    DescribeShape(run);
    runs.push_back(std::move(run));
  }
  return runs;
}

}  // namespace hv::sim
