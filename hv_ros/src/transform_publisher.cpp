#include "hv_ros/transform_publisher.h"

#include <utility>

#include <geometry_msgs/TransformStamped.h>

#include "hv_ros/conversions.h"
#include "hv_ros/message_checks.h"

namespace hv {
namespace {

/// tf complains about a stamp that it has already; a larger step back is a jump of the clock.
bool IsRepeated(Time stamp, const std::optional<Time>& last) {
  constexpr double kJump = 1.0;  // [s]
  return last && stamp <= *last && *last - stamp < kJump;
}

}  // namespace

TransformPublisher::TransformPublisher(TransformOptions options)
    : options_(std::move(options)), correction_(options_.correction_s) {}

void TransformPublisher::Update(const Pose& T_map_odom, bool at_once) {
  const std::lock_guard<std::mutex> lock(mutex_);
  withdrawn_ = false;
  if (at_once) {
    correction_.JumpTo(T_map_odom);
  } else {
    correction_.MoveTo(T_map_odom);
  }
}

void TransformPublisher::Withdraw() {
  const std::lock_guard<std::mutex> lock(mutex_);
  withdrawn_ = true;
}

void TransformPublisher::OnOdometry(const nav_msgs::Odometry& odometry) {
  if (!options_.publish || !IsPose(odometry.pose.pose)) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (withdrawn_) return;
  const Time stamp = FromRos(odometry.header.stamp);
  if (IsRepeated(stamp, last_)) return;
  last_ = stamp;
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = ToRos(stamp + options_.tolerance_s);
  transform.header.frame_id = options_.map_frame;
  transform.child_frame_id = odometry.header.frame_id;
  transform.transform = ToTransform(correction_.At(stamp, FromRos(odometry.pose.pose)));
  broadcaster_.sendTransform(transform);
}

}  // namespace hv
