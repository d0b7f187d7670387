#pragma once

#include "hv_core/se3.h"

namespace hv::relocalize {

/// The covariance of the base's pose as geometry_msgs wants it: x y z rx ry rz, both parts in axes
/// of the map [m^2, rad^2]. `covariance`: of T_map_imu, right perturbation, translation then
/// rotation. Pure.
Matrix6d CovarianceOfBase(const Pose& T_map_imu, const Matrix6d& covariance,
                          const Pose& T_imu_base);

}  // namespace hv::relocalize
