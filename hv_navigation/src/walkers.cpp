#include "hv_navigation/walkers.h"

#include <algorithm>
#include <array>

namespace hv::navigation {
namespace {

using Eigen::Vector2d;

struct Stretch {
  Vector2d from;
  Vector2d to;
};

/// Where a walker may be: on a stretch of the straight line ahead.
Stretch StretchOf(const WalkConfig& config, const Walker& walker, Time then) {
  const double gone_s = std::max(0.0, then - walker.stamp);
  return {walker.place + config.least_mps * gone_s * walker.direction,
          walker.place + config.most_mps * gone_s * walker.direction};
}

double DistanceTo(const Stretch& stretch, const Vector2d& point) {
  const Vector2d along = stretch.to - stretch.from;
  const double length2 = along.squaredNorm();
  const double share =
      length2 > 0.0 ? std::clamp((point - stretch.from).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (stretch.from + share * along - point).norm();
}

/// An upright rectangle.
struct Box {
  Vector2d low;
  Vector2d high;

  double DistanceTo(const Vector2d& point) const {
    return (point - point.cwiseMax(low).cwiseMin(high)).norm();
  }
};

/// Whether some of the stretch lies inside (Liang and Barsky 1984).
bool Crosses(const Box& box, const Stretch& stretch) {
  const Vector2d along = stretch.to - stretch.from;
  double first = 0.0;
  double last = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    double low = box.low[axis] - stretch.from[axis];
    double high = box.high[axis] - stretch.from[axis];
    if (along[axis] == 0.0) {
      if (low > 0.0 || high < 0.0) return false;
      continue;
    }
    if (along[axis] < 0.0) std::swap(low, high);
    first = std::max(first, low / along[axis]);
    last = std::min(last, high / along[axis]);
  }
  return first <= last;
}

/// Two convex shapes apart are nearest at a corner of one of them.
double Distance(const Box& box, const Stretch& stretch) {
  if (Crosses(box, stretch)) return 0.0;
  double distance = std::min(box.DistanceTo(stretch.from), box.DistanceTo(stretch.to));
  const std::array<Vector2d, 4> corners = {box.low, box.high, Vector2d(box.low.x(), box.high.y()),
                                           Vector2d(box.high.x(), box.low.y())};
  for (const Vector2d& corner : corners) {
    distance = std::min(distance, DistanceTo(stretch, corner));
  }
  return distance;
}

Box BoxOf(const Footprint& footprint) {
  const double side_m = footprint.half_width_m + footprint.margin_m;
  return {{-footprint.back_m - footprint.margin_m, -side_m},
          {footprint.front_m + footprint.margin_m, side_m}};
}

}  // namespace

void WalkConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("least_mps", least_mps, "slowest that people walk [m/s]");
  visitor.Field("most_mps", most_mps, "and fastest [m/s]");
  visitor.Field("any_way_mps", any_way_mps,
                "as long as the robot moves, they may come from any side as fast [m/s]");
  visitor.Field("any_way_m", any_way_m,
                "and from so much nearer than they were noticed: what is seen of them lags [m]");
  visitor.Field("horizon_s", horizon_s, "they go on straight for so long [s]");
  visitor.Field("radius_m", radius_m, "of a person [m]");
}

void WalkConfig::Validate(ConfigProblems& problems) const {
  problems.Require(least_mps >= 0.0, "walk.least_mps", "must not be negative");
  problems.Require(most_mps >= least_mps, "walk.most_mps", "must be at least walk.least_mps");
  problems.Require(any_way_mps >= 0.0, "walk.any_way_mps", "must not be negative");
  problems.Require(any_way_m >= 0.0, "walk.any_way_m", "must not be negative");
  problems.Require(horizon_s > 0.0, "walk.horizon_s", "must be positive");
  problems.Require(radius_m > 0.0, "walk.radius_m", "must be positive");
}

bool Walkers::MayTouch(const Footprint& footprint, const PlanarPose& pose, Time then) const {
  if (walkers_.empty()) return false;
  const double reach_m = footprint.CircumscribedRadius() + config_.radius_m;
  const Box robot = BoxOf(footprint);
  const PlanarPose T_robot = pose.Inverse();
  return std::any_of(walkers_.begin(), walkers_.end(), [&](const Walker& walker) {
    const Stretch stretch = StretchOf(config_, walker, then);
    if (DistanceTo(stretch, pose.position) > reach_m) return false;
    return Distance(robot, {T_robot * stretch.from, T_robot * stretch.to}) <= config_.radius_m;
  });
}

bool Walkers::MayReach(const Footprint& footprint, const PlanarPose& pose, Time then) const {
  if (walkers_.empty() && perhaps_.empty()) return false;
  const Box robot = BoxOf(footprint);
  const PlanarPose T_robot = pose.Inverse();
  const auto may_reach = [&](const Walker& walker) {
    const double gone_m =
        config_.any_way_m + config_.any_way_mps * std::max(0.0, then - walker.stamp);
    return robot.DistanceTo(T_robot * walker.place) <= config_.radius_m + gone_m;
  };
  return std::any_of(walkers_.begin(), walkers_.end(), may_reach) ||
         std::any_of(perhaps_.begin(), perhaps_.end(), may_reach);
}

bool Walkers::MayBeNear(const Vector2d& place, double distance_m, Time then) const {
  return std::any_of(walkers_.begin(), walkers_.end(), [&](const Walker& walker) {
    return MayBeNear(config_, walker, place, distance_m, then);
  });
}

bool Walkers::MayBeNear(const WalkConfig& config, const Walker& walker, const Vector2d& place,
                        double distance_m, Time then) {
  return DistanceTo(StretchOf(config, walker, then), place) <= distance_m;
}

}  // namespace hv::navigation
