#include "frames.h"

namespace hv::navigation {

std::optional<Pose> PlaceOfOdometry(const tf2_ros::Buffer& buffer, const std::string& map_frame,
                                    const std::string& odom_frame, Time newest, double timeout_s) {
  const auto transform = NewestTransform(buffer, map_frame, odom_frame);
  if (!transform) return std::nullopt;
  const bool always = transform->stamp == Time();
  if (!always && newest - transform->stamp > timeout_s) return std::nullopt;
  return transform->T_parent_child;
}

bool PlaceJumps::Add(Time stamp, const Pose& T_map_odom, const Pose& T_odom_base) {
  constexpr double kWithin_s = 2.0;
  if (!places_.empty() && stamp < places_.back().stamp) places_.clear();
  while (places_.size() > 1 && stamp - places_.front().stamp > kWithin_s) places_.pop_front();
  bool jumped = false;
  if (!places_.empty()) {
    const Pose before = places_.front().T_map_odom * T_odom_base;
    const Pose now = T_map_odom * T_odom_base;
    jumped = (now.translation() - before.translation()).norm() > distance_m_ ||
             RotationDistance(now, before) > angle_rad_;
  }
  if (jumped) places_.clear();
  places_.push_back({stamp, T_map_odom});
  return jumped;
}

}  // namespace hv::navigation
