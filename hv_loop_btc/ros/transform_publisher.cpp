#include "transform_publisher.h"

#include <geometry_msgs/TransformStamped.h>

#include "hv_ros/conversions.h"

namespace hv::loop {
namespace {

/// tf complains about a stamp that it has already; a larger step back is a jump of the clock.
bool IsRepeated(Time stamp, const std::optional<Time>& last) {
  constexpr double kJump = 1.0;  // [s]
  return last && stamp <= *last && *last - stamp < kJump;
}

bool IsUsable(const nav_msgs::Odometry& odometry) {
  const auto& p = odometry.pose.pose.position;
  const auto& q = odometry.pose.pose.orientation;
  return Eigen::Vector3d(p.x, p.y, p.z).allFinite() &&
         std::abs(Eigen::Vector4d(q.x, q.y, q.z, q.w).norm() - 1.0) < 1e-3;
}

}  // namespace

TransformPublisher::TransformPublisher(const MappingNodeConfig& config)
    : config_(config), correction_(config.correction_s) {}

void TransformPublisher::Update(const Pose& T_map_odom, bool at_once) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (at_once) {
    correction_.JumpTo(T_map_odom);
  } else {
    correction_.MoveTo(T_map_odom);
  }
}

void TransformPublisher::OnOdometry(const nav_msgs::Odometry& odometry) {
  if (!config_.publish_tf || !IsUsable(odometry)) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  const Time stamp = FromRos(odometry.header.stamp);
  if (IsRepeated(stamp, last_)) return;
  last_ = stamp;
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = ToRos(stamp + config_.tf_tolerance_s);
  transform.header.frame_id = config_.map_frame;
  transform.child_frame_id = odometry.header.frame_id;
  transform.transform = ToTransform(correction_.At(stamp, FromRos(odometry.pose.pose)));
  broadcaster_.sendTransform(transform);
}

}  // namespace hv::loop
