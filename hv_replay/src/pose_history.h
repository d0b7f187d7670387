#pragma once

#include <deque>
#include <optional>

#include "hv_core/se3.h"
#include "hv_core/time.h"
#include "hv_navigation/planar.h"

namespace hv::replay {

/// Where the base was in the frame of odometry, and how it moved.
struct BaseMotion {
  Time stamp;
  Pose T_odom_base = Pose::Identity();
  navigation::Velocity velocity;
};

/// The last second of a motion.
class PoseHistory {
 public:
  /// In order of time; what is not later than the last one takes its place.
  void Add(const BaseMotion& motion);
  void Clear() { motions_.clear(); }

  /// Poses between those added are interpolated, velocities those of the later one; up to 50 ms
  /// after the last one it is taken to stand for `stamp`.
  std::optional<BaseMotion> At(Time stamp) const;

 private:
  std::deque<BaseMotion> motions_;
};

}  // namespace hv::replay
