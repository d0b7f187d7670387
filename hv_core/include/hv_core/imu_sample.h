#pragma once

#include <Eigen/Core>

#include "hv_core/time.h"

namespace hv {

/// One IMU reading in the IMU frame.
struct ImuSample {
  Time stamp;
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< [rad/s]
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();      ///< specific force [m/s^2]
};

}  // namespace hv
