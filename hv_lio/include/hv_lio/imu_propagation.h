#pragma once

#include <vector>

#include "hv_core/config.h"
#include "hv_core/imu_sample.h"
#include "hv_lio/nav_state.h"

namespace hv::lio {

/// Noise of the IMU as the filter assumes it, and where the sensor saturates.
struct ImuNoiseConfig {
  double gyro_noise = 5e-4;     // rad/s/sqrt(Hz)
  double accel_noise = 5e-3;    // m/s^2/sqrt(Hz)
  double gyro_walk = 1e-5;      // rad/s^2/sqrt(Hz)
  double accel_walk = 1e-4;     // m/s^3/sqrt(Hz)
  double gyro_limit = 35.0;     // rad/s
  double accel_limit = 157.0;   // m/s^2
  double saturated_factor = 30.0;
  double gap_gyro_noise = 0.5;  // rad/s/sqrt(Hz)
  double gap_accel_noise = 5.0;  // m/s^2/sqrt(Hz)

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Motion over one IMU interval: constant angular velocity and constant acceleration in odom.
struct MotionKnot {
  double time = 0.0;  ///< start of the interval, relative to the reference given to Propagate [s]
  Eigen::Vector3d position = Eigen::Vector3d::Zero();          ///< odom [m]
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();      ///< R_odom_imu
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< odom [m/s]
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();      ///< odom [m/s^2]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< imu [rad/s]

  /// Pose `dt` seconds after `time`.
  Pose PoseAfter(double dt) const;
};

/// What a step rests on: a good reading, one at the sensor's limit, or none because the IMU was
/// silent.
enum class ImuQuality { kMeasured, kSaturated, kMissing };

/// One step of the process model with a constant reading over `dt` seconds.
struct ImuStep {
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< measured [rad/s]
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();      ///< measured [m/s^2]
  double dt = 0.0;                                             ///< [s]
  ImuQuality quality = ImuQuality::kMeasured;
};

/// Mean part of the step (methods section 1, propagation; midpoint attitude for the specific
/// force). A missing reading keeps the velocity. Returns the interval's motion, for deskewing.
MotionKnot PropagateState(const ImuStep& step, NavState& state);

/// F = d x_{k+1} / d x_k of PropagateState at `state`, in error coordinates.
ErrorMatrix PropagationJacobian(const ImuStep& step, const NavState& state);

/// P <- F P F^T + Q dt.
void PropagateCovariance(const ImuStep& step, const NavState& state, const ImuNoiseConfig& noise,
                         ErrorMatrix& covariance);

}  // namespace hv::lio
