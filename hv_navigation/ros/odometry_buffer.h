#pragma once

#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

#include <nav_msgs/Odometry.h>

#include "hv_core/se3.h"
#include "hv_core/time.h"
#include "hv_navigation/planar.h"

namespace hv::navigation {

/// What odometry says of the base.
struct OdometryState {
  Time stamp;
  Time arrival;  ///< on the clock of ROS
  std::string odom_frame;
  std::string base_frame;
  Pose T_odom_base = Pose::Identity();
  Velocity velocity;
};

/// The odometry of the last seconds. Thread-safe.
class OdometryBuffer {
 public:
  /// False for a message with something not finite: it is left out, and counted. One that is older
  /// than the last one says that the clock has jumped: what was before is forgotten.
  bool Add(const nav_msgs::Odometry& message, Time arrival);

  std::optional<OdometryState> Newest() const;

  /// T_odom_base at `stamp`, between messages or shortly behind the last one; nullopt elsewhere.
  std::optional<Pose> PoseAt(Time stamp) const;

  /// The instant on the clock of the sensors. That is the clock of ROS, unless their stamps are so
  /// far off that it must be another one.
  Time SensorTime(Time ros_now) const;

  std::size_t refused() const;

 private:
  mutable std::mutex mutex_;  // guards everything below
  std::deque<OdometryState> states_;
  std::size_t refused_ = 0;
};

}  // namespace hv::navigation
