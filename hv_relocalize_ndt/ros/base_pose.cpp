#include "base_pose.h"

namespace hv::relocalize {

Matrix6d CovarianceOfBase(const Pose& T_map_imu, const Matrix6d& covariance,
                          const Pose& T_imu_base) {
  // T_map_imu Exp(xi) T_imu_base = T_map_base Exp(Ad(T_imu_base^-1) xi), then its axes turned.
  const Eigen::Matrix3d R_map_base = (T_map_imu * T_imu_base).linear();
  Matrix6d jacobian = Matrix6d::Zero();
  jacobian.topLeftCorner<3, 3>() = R_map_base;
  jacobian.bottomRightCorner<3, 3>() = R_map_base;
  jacobian = jacobian * se3::Adjoint(T_imu_base.inverse());
  const Matrix6d moved = jacobian * covariance * jacobian.transpose();
  return 0.5 * (moved + moved.transpose());
}

}  // namespace hv::relocalize
