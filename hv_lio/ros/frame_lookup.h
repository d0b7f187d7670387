#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include "hv_core/se3.h"

namespace hv::lio {

/// Fixed transforms of the robot from tf. Needed only while starting; nothing is listened to later,
/// so jumps of the clock cannot leave stale transforms behind. The time of each lookup is "latest",
/// and waiting goes by wall time, so that it also ends when simulated time stands still.
class FrameLookup {
 public:
  /// Every wait ends early once `stop` is set.
  explicit FrameLookup(const std::atomic<bool>& stop) : stop_(stop), listener_(buffer_) {}

  /// T_parent_child, as soon as tf knows it; nullopt after `timeout_s`.
  std::optional<Pose> Wait(const std::string& parent, const std::string& child, double timeout_s);

 private:
  const std::atomic<bool>& stop_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
};

}  // namespace hv::lio
