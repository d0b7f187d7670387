#include "body_estimate.h"

#include "hv_core/so3.h"

namespace hv::lio {
namespace {

/// J Sigma J^T, exactly symmetric.
Matrix6d Transport(const Matrix6d& jacobian, const Matrix6d& covariance) {
  const Matrix6d moved = jacobian * covariance * jacobian.transpose();
  return 0.5 * (moved + moved.transpose());
}

}  // namespace

BodyEstimate MoveToBody(const OdometryEstimate& estimate, const Pose& T_body_imu) {
  const Pose T_imu_body = T_body_imu.inverse();
  const Eigen::Matrix3d R_body_imu = T_body_imu.linear();
  const Eigen::Matrix3d R_imu_odom = estimate.T_odom_imu.linear().transpose();
  const Eigen::Vector3d lever_odom = estimate.T_odom_imu.linear() * T_imu_body.translation();

  BodyEstimate body;
  body.stamp = estimate.stamp;
  body.T_odom_body = estimate.T_odom_imu * T_imu_body;

  // v_body = R_body_imu (v_imu + w x lever), w_body = R_body_imu w.
  Matrix6d twist_jacobian = Matrix6d::Zero();
  twist_jacobian.topLeftCorner<3, 3>() = R_body_imu;
  twist_jacobian.topRightCorner<3, 3>() = -R_body_imu * so3::Hat(T_imu_body.translation());
  twist_jacobian.bottomRightCorner<3, 3>() = R_body_imu;
  Vector6d imu_twist;
  imu_twist << R_imu_odom * estimate.velocity_odom, estimate.angular_velocity_imu;
  body.twist = twist_jacobian * imu_twist;
  body.twist_covariance = Transport(twist_jacobian, estimate.twist_covariance);

  // p_body = p_imu + R lever, with R perturbed in odom axes.
  Matrix6d pose_jacobian = Matrix6d::Identity();
  pose_jacobian.topRightCorner<3, 3>() = -so3::Hat(lever_odom);
  body.pose_covariance = Transport(pose_jacobian, estimate.pose_covariance);
  return body;
}

}  // namespace hv::lio
