#pragma once

#include <Eigen/Core>

#include "hv_core/se3.h"
#include "hv_lio/scan_preprocessor.h"
#include "hv_lio/voxel.h"

namespace hv::lio {

/// One scalar measurement of the pose (R, p): `value` ~ N(0, variance) at the true pose.
struct Residual {
  double value = 0.0;     ///< [m]
  double variance = 0.0;  ///< [m^2]
  Vector6d jacobian = Vector6d::Zero();  ///< by position (odom), then rotation (right, IMU frame)
};

/// Distance of a cell's mean from a plane along the plane's normal (methods section 1): variance
/// from the cell (measurement noise or observed scatter along the normal, whichever is larger,
/// averaged over its points) and from the plane.
Residual PlaneResidual(const SurfaceCell& cell, const SurfaceFeature& plane,
                       const Pose& T_odom_imu);

/// Distance of a cell's mean from the mean of a Gaussian along the Gaussian's axis `axis` (0, 1, 2),
/// one row of the whitened residual of methods section 1.
Residual GaussianResidual(const SurfaceCell& cell, const SurfaceFeature& gaussian, int axis,
                          const Pose& T_odom_imu);

}  // namespace hv::lio
