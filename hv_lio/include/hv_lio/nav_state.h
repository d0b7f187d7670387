#pragma once

#include <Eigen/Core>

#include "hv_core/se3.h"

namespace hv::lio {

/// Dimension of the error state: position, rotation, velocity, gyroscope bias, accelerometer bias,
/// gravity direction.
inline constexpr int kErrorDim = 17;
using ErrorVector = Eigen::Matrix<double, kErrorDim, 1>;
using ErrorMatrix = Eigen::Matrix<double, kErrorDim, kErrorDim>;

/// First index of each block of the error state.
struct ErrorIndex {
  static constexpr int kPosition = 0;  ///< odom frame [m]
  static constexpr int kRotation = 3;  ///< right-multiplied, IMU frame [rad]
  static constexpr int kVelocity = 6;  ///< odom frame [m/s]
  static constexpr int kGyroBias = 9;  ///< IMU frame [rad/s]
  static constexpr int kAccelBias = 12;  ///< IMU frame [m/s^2]
  static constexpr int kGravity = 15;    ///< tangent of the sphere, 2 components [rad]
};

/// State of the filter (methods: x = (R, p, v, b_g, b_a, g)) in the gravity-aligned odom frame.
struct NavState {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();    ///< of the IMU in odom [m]
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< R_odom_imu
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();    ///< of the IMU in odom [m/s]
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();   ///< [rad/s]
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();  ///< [m/s^2]
  Eigen::Vector3d gravity{0.0, 0.0, -9.80665};           ///< in odom [m/s^2], norm is constant

  Pose T_odom_imu() const { return MakePose(rotation, position); }

  /// State displaced by an error vector.
  NavState Plus(const ErrorVector& delta) const;

  /// Error vector from `other` to this: other.Plus(Minus(other)) is this.
  ErrorVector Minus(const NavState& other) const;

  /// d Minus(Plus(delta), other) / d delta at delta = 0: the Jacobian that carries a prior about
  /// `other` to this linearisation point.
  ErrorMatrix MinusJacobian(const NavState& other) const;
};

/// Orthonormal 3 x 2 basis of the plane perpendicular to `direction` (any norm but zero).
Eigen::Matrix<double, 3, 2> TangentBasis(const Eigen::Vector3d& direction);

}  // namespace hv::lio
