#pragma once

#include "hv_core/se3.h"
#include "hv_lio/odometry_result.h"

namespace hv::lio {

/// The odometry of a body fixed to the IMU (usually base_link), in the order and frames that
/// nav_msgs/Odometry wants.
struct BodyEstimate {
  Time stamp;
  Pose T_odom_body = Pose::Identity();
  Vector6d twist = Vector6d::Zero();  ///< vx vy vz wx wy wz of the body origin, body axes [m/s, rad/s]
  Matrix6d pose_covariance = Matrix6d::Zero();   ///< x y z rx ry rz, odom axes [m^2, rad^2]
  Matrix6d twist_covariance = Matrix6d::Zero();  ///< of `twist`
};

/// Carries an estimate of the IMU over to the body through the lever arm, covariances to first
/// order.
BodyEstimate MoveToBody(const OdometryEstimate& estimate, const Pose& T_body_imu);

}  // namespace hv::lio
