#include "hv_loop_btc/pose_graph_residuals.h"

#include "hv_core/so3.h"

namespace hv::loop {

Vector6d RelativePoseResidual(const Pose& T_from_to, const Pose& T_map_from, const Pose& T_map_to,
                              Matrix6d* by_from, Matrix6d* by_to) {
  const Pose T_to_from = T_map_to.inverse() * T_map_from;
  Vector6d residual = -se3::Log(T_to_from * T_from_to);
  if (by_from == nullptr && by_to == nullptr) return residual;
  const Matrix6d by_error = se3::RightJacobianInverse(residual);
  if (by_to != nullptr) *by_to = by_error;
  if (by_from != nullptr) *by_from = -by_error * se3::Adjoint(T_to_from);
  return residual;
}

Eigen::Vector2d TiltResidual(const Eigen::Vector3d& up_imu, const Pose& T_map_imu,
                             TiltJacobian* by_pose) {
  if (by_pose != nullptr) {
    by_pose->leftCols<3>().setZero();
    by_pose->rightCols<3>() = -(T_map_imu.linear() * so3::Hat(up_imu)).topRows<2>();
  }
  return (T_map_imu.linear() * up_imu).head<2>();
}

}  // namespace hv::loop
