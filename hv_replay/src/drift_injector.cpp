#include "hv_replay/drift_injector.h"

#include <cmath>

namespace hv::replay {

Pose DriftInjector::Apply(const Pose& T_odom_imu) {
  if (!last_) {
    last_ = T_odom_imu;
    drifted_ = T_odom_imu;
    return drifted_;
  }
  Pose step = last_->inverse() * T_odom_imu;
  const double turn = rates_.deg_per_m * M_PI / 180.0 * step.translation().norm();
  step.translation() *= 1.0 + rates_.share;
  const Eigen::Vector3d position = drifted_ * step.translation();
  const Eigen::Matrix3d rotation =
      RotationFromRpy(0.0, 0.0, turn) * drifted_.linear() * step.linear();
  drifted_ = MakePose(rotation, position);
  last_ = T_odom_imu;
  return drifted_;
}

}  // namespace hv::replay
