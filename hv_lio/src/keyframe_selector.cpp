#include "hv_lio/keyframe_selector.h"

#include <cmath>

namespace hv::lio {

std::optional<Keyframe> KeyframeSelector::Add(const ScanResult& result) {
  if (result.status != ScanStatus::kTracking || !result.deskewed) return std::nullopt;
  const Pose& T_odom_imu = result.estimate.T_odom_imu;
  if (result.segment == segment_ && !FarFromLast(T_odom_imu)) return std::nullopt;
  segment_ = result.segment;
  last_ = T_odom_imu;
  Keyframe keyframe;
  keyframe.id = next_id_++;
  keyframe.segment = result.segment;
  keyframe.stamp = result.estimate.stamp;
  keyframe.T_odom_imu = T_odom_imu;
  keyframe.covariance = result.estimate.pose_covariance;
  keyframe.gravity_odom = result.estimate.gravity_odom;
  keyframe.degenerate_translation = result.update.degenerate_translation;
  keyframe.degenerate_rotation = result.update.degenerate_rotation;
  keyframe.points = *result.deskewed;
  return keyframe;
}

bool KeyframeSelector::FarFromLast(const Pose& T_odom_imu) const {
  if (!last_) return true;
  return (T_odom_imu.translation() - last_->translation()).norm() >= distance_m_ ||
         RotationDistance(T_odom_imu, *last_) >= angle_deg_ * M_PI / 180.0;
}

}  // namespace hv::lio
