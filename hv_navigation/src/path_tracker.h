#pragma once

#include <vector>

#include "hv_navigation/path.h"

namespace hv::navigation {

/// Where along a path a robot is. A path falls into stretches, at the ends of which it turns on the
/// spot; only the stretch being driven is looked at. Not thread-safe.
class PathTracker {
 public:
  struct Place {
    double along_m = 0.0;     ///< from the start of the path
    double distance_m = 0.0;  ///< from the path
    double heading = 0.0;     ///< of the path there [rad]
  };

  explicit PathTracker(const Path& path);

  bool Empty() const { return points_.empty(); }
  const PlanarPose& goal() const { return goal_; }

  /// Into another frame.
  void Move(const PlanarPose& T_new_old);

  /// Moves on to where `position` is, never back.
  void Advance(const Eigen::Vector2d& position);

  /// The nearest place of the stretch, from the robot's on, within `window_m`.
  Place Nearest(const Eigen::Vector2d& position, double window_m) const;

  Eigen::Vector2d PointAhead(double distance_m) const;

  /// Poses of the path between two distances ahead of the robot, over all stretches.
  Path Ahead(double from_m, double to_m) const;

  double Along() const { return along_m_; }
  double Remaining() const { return points_.back().along_m - along_m_; }
  /// To the end of the stretch [m].
  const Eigen::Vector2d& StopPoint() const { return points_[end_].position; }
  double ToStop() const { return points_[end_].along_m - along_m_; }
  bool OnLastStretch() const { return end_ + 1 == points_.size(); }

 private:
  struct Point {
    Eigen::Vector2d position;
    double heading = 0.0;  ///< towards the next point
    double along_m = 0.0;
  };

  std::size_t EndOfStretch(std::size_t from) const;
  Place OnSegment(std::size_t i, const Eigen::Vector2d& position) const;

  std::vector<Point> points_;  ///< no two at the same place
  PlanarPose goal_;
  std::size_t at_ = 0;   ///< segment of the robot, by its first point
  std::size_t end_ = 0;  ///< last point of the stretch
  double along_m_ = 0.0;
};

}  // namespace hv::navigation
