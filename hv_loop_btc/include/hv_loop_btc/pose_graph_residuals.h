#pragma once

#include <Eigen/Core>

#include "hv_core/se3.h"

/// Residuals of the pose graph with their derivatives by right-multiplied perturbations of the
/// poses, T <- T Exp(xi), translation first. Pure functions, without weights.
namespace hv::loop {

/// Residual of a measured relative pose (paper Eq. 5) [m, rad]: Log(T_from_to^-1 * T_map_from^-1 *
/// T_map_to). Fills the Jacobians that are not null.
Vector6d RelativePoseResidual(const Pose& T_from_to, const Pose& T_map_from, const Pose& T_map_to,
                              Matrix6d* by_from = nullptr, Matrix6d* by_to = nullptr);

using TiltJacobian = Eigen::Matrix<double, 2, 6>;

/// Horizontal part in the map of the unit vector `up_imu`, the direction against gravity as
/// measured in the IMU frame: the tilt of the pose [rad] while that is small. Free of yaw and
/// position. Fills the Jacobian if not null.
Eigen::Vector2d TiltResidual(const Eigen::Vector3d& up_imu, const Pose& T_map_imu,
                             TiltJacobian* by_pose = nullptr);

}  // namespace hv::loop
