#include "odometry_buffer.h"

#include <algorithm>
#include <cmath>

#include "hv_core/trajectory.h"
#include "hv_ros/conversions.h"
#include "hv_ros/message_checks.h"

namespace hv::navigation {
namespace {

constexpr double kKept_s = 3.0;
constexpr double kLongestGap_s = 0.5;
constexpr double kAhead_s = 0.2;
constexpr double kOtherClock_s = 5.0;

Pose Ahead(const OdometryState& state, double seconds) {
  Vector6d xi = Vector6d::Zero();
  xi[0] = state.velocity.linear_mps * seconds;
  xi[5] = state.velocity.angular_rps * seconds;
  return state.T_odom_base * se3::Exp(xi);
}

}  // namespace

bool OdometryBuffer::Add(const nav_msgs::Odometry& message, Time arrival) {
  const Velocity velocity{message.twist.twist.linear.x, message.twist.twist.angular.z};
  const bool usable = IsPose(message.pose.pose) && std::isfinite(velocity.linear_mps) &&
                      std::isfinite(velocity.angular_rps);
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!usable) {
    ++refused_;
    return false;
  }
  const Time stamp = FromRos(message.header.stamp);
  if (!states_.empty() && stamp <= states_.back().stamp) states_.clear();
  states_.push_back({stamp, arrival, message.header.frame_id, message.child_frame_id,
                     FromRos(message.pose.pose), velocity});
  while (stamp - states_.front().stamp > kKept_s) states_.pop_front();
  return true;
}

std::optional<OdometryState> OdometryBuffer::Newest() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (states_.empty()) return std::nullopt;
  return states_.back();
}

std::optional<Pose> OdometryBuffer::PoseAt(Time stamp) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (states_.empty()) return std::nullopt;
  const OdometryState& newest = states_.back();
  if (stamp >= newest.stamp) {
    const double ahead_s = stamp - newest.stamp;
    return ahead_s <= kAhead_s ? std::optional<Pose>(Ahead(newest, ahead_s)) : std::nullopt;
  }
  const auto after =
      std::upper_bound(states_.begin(), states_.end(), stamp,
                       [](Time value, const OdometryState& state) { return value < state.stamp; });
  if (after == states_.begin()) return std::nullopt;
  const auto before = std::prev(after);
  return Trajectory({{before->stamp, before->T_odom_base}, {after->stamp, after->T_odom_base}})
      .Interpolate(stamp, kLongestGap_s);
}

Time OdometryBuffer::SensorTime(Time ros_now) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (states_.empty()) return ros_now;
  const double offset_s = states_.back().stamp - states_.back().arrival;
  return std::abs(offset_s) > kOtherClock_s ? ros_now + offset_s : ros_now;
}

std::size_t OdometryBuffer::refused() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return refused_;
}

}  // namespace hv::navigation
