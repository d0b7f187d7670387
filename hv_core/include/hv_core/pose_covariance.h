#pragma once

#include "hv_core/se3.h"

namespace hv {

/// The covariance of T_map_imu * T_imu_base as geometry_msgs wants it: x y z rx ry rz, both parts
/// in axes of the map [m^2, rad^2]. `covariance`: of T_map_imu, right perturbation, translation
/// then rotation. Pure.
Matrix6d CovarianceInMapAxes(const Pose& T_map_imu, const Matrix6d& covariance,
                             const Pose& T_imu_base = Pose::Identity());

/// The direction in which a position is least certain.
struct WeakestDirection {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< unit, either sense
  double sigma_m = 0.0;
};

/// Of a covariance with the position first, in its axes. Pure.
WeakestDirection WeakestDirectionOf(const Matrix6d& covariance);

}  // namespace hv
