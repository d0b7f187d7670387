#include "hv_core/pose_covariance.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace hv {

Matrix6d CovarianceInMapAxes(const Pose& T_map_imu, const Matrix6d& covariance,
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

WeakestDirection WeakestDirectionOf(const Matrix6d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance.topLeftCorner<3, 3>());
  return {solver.eigenvectors().col(2), std::sqrt(std::max(0.0, solver.eigenvalues()[2]))};
}

}  // namespace hv
