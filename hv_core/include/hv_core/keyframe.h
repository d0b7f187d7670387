#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "hv_core/scan.h"
#include "hv_core/se3.h"
#include "hv_core/time.h"

namespace hv {

/// One key scan of the odometry: what loop closing, maps and localisation build on.
struct Keyframe {
  std::uint32_t id = 0;       ///< 0, 1, 2 ... in order of time, never reused
  std::uint32_t segment = 0;  ///< grows when the odometry starts anew: no edge across
  Time stamp;                 ///< end of the scan, the instant of the pose
  Pose T_odom_imu = Pose::Identity();
  /// x y z rx ry rz; translation and rotation both in axes of odom [m^2, rad^2].
  Matrix6d covariance = Matrix6d::Identity();
  Eigen::Vector3d gravity_odom{0.0, 0.0, -9.80665};  ///< [m/s^2]
  /// Unit directions that the scan could not observe (odom axes; imu axes).
  std::vector<Eigen::Vector3d> degenerate_translation;
  std::vector<Eigen::Vector3d> degenerate_rotation;
  std::vector<Point> points;  ///< deskewed to `stamp`, IMU frame
};

}  // namespace hv
