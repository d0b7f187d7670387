#include "path_tracker.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hv::navigation {
namespace {

constexpr double kSamePlace_m = 1e-4;
constexpr double kSharpTurn = 0.6;  // rad; arcs of a path turn less between two poses
constexpr double kWindow_m = 2.0;
constexpr double kAtStop_m = 0.1;

}  // namespace

PathTracker::PathTracker(const Path& path) {
  for (const PlanarPose& pose : path) {
    const bool same =
        !points_.empty() && (pose.position - points_.back().position).norm() < kSamePlace_m;
    if (same) continue;
    Point point;
    point.position = pose.position;
    if (!points_.empty()) {
      Point& last = points_.back();
      const Eigen::Vector2d way = point.position - last.position;
      last.heading = std::atan2(way.y(), way.x());
      point.heading = last.heading;
      point.along_m = last.along_m + way.norm();
    }
    points_.push_back(point);
  }
  if (points_.empty()) return;
  goal_ = path.back();
  end_ = EndOfStretch(0);
}

void PathTracker::Move(const PlanarPose& T_new_old) {
  for (Point& point : points_) {
    point.position = T_new_old * point.position;
    point.heading = WrappedAngle(point.heading + T_new_old.yaw);
  }
  goal_ = T_new_old * goal_;
}

Path PathTracker::Ahead(double from_m, double to_m) const {
  Path path;
  for (std::size_t i = at_; i < points_.size(); ++i) {
    const double ahead_m = points_[i].along_m - along_m_;
    if (ahead_m > to_m) break;
    if (ahead_m >= from_m) path.push_back({points_[i].position, points_[i].heading});
  }
  return path;
}

std::size_t PathTracker::EndOfStretch(std::size_t from) const {
  for (std::size_t i = from + 1; i + 1 < points_.size(); ++i) {
    const double turn = WrappedAngle(points_[i].heading - points_[i - 1].heading);
    if (std::abs(turn) > kSharpTurn) return i;
  }
  return points_.size() - 1;
}

PathTracker::Place PathTracker::OnSegment(std::size_t i, const Eigen::Vector2d& position) const {
  const Point& point = points_[i];
  const Eigen::Vector2d ahead(std::cos(point.heading), std::sin(point.heading));
  const double length_m = i < end_ ? points_[i + 1].along_m - point.along_m : 0.0;
  const double along_m = std::clamp((position - point.position).dot(ahead), 0.0, length_m);
  return {point.along_m + along_m, (position - point.position - along_m * ahead).norm(),
          point.heading};
}

PathTracker::Place PathTracker::Nearest(const Eigen::Vector2d& position, double window_m) const {
  Place best;
  best.distance_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = at_; i == at_ || i < end_; ++i) {
    if (points_[i].along_m > along_m_ + window_m) break;
    const Place place = OnSegment(i, position);
    if (place.distance_m < best.distance_m) best = place;
  }
  best.along_m = std::max(best.along_m, along_m_);
  return best;
}

void PathTracker::Advance(const Eigen::Vector2d& position) {
  along_m_ = Nearest(position, kWindow_m).along_m;
  while (at_ < end_ && points_[at_ + 1].along_m <= along_m_) ++at_;
  const double to_stop_m = (points_[end_].position - position).norm();
  if (OnLastStretch() || ToStop() > kAtStop_m || to_stop_m > 2.0 * kAtStop_m) return;
  at_ = end_;
  along_m_ = points_[at_].along_m;
  end_ = EndOfStretch(at_);
}

Eigen::Vector2d PathTracker::PointAhead(double distance_m) const {
  const double along_m = along_m_ + distance_m;
  std::size_t i = at_;
  while (i < end_ && points_[i + 1].along_m < along_m) ++i;
  if (i == end_) return points_[end_].position;
  const double share =
      (along_m - points_[i].along_m) / (points_[i + 1].along_m - points_[i].along_m);
  return points_[i].position + share * (points_[i + 1].position - points_[i].position);
}

}  // namespace hv::navigation
