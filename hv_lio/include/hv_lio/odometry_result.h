#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "hv_core/scan.h"
#include "hv_core/se3.h"
#include "hv_core/time.h"

namespace hv::lio {

/// Pose, velocity and their uncertainty at one instant. Frames: odom (gravity-aligned, z up) and
/// imu.
struct OdometryEstimate {
  Time stamp;
  Pose T_odom_imu = Pose::Identity();
  Eigen::Vector3d velocity_odom = Eigen::Vector3d::Zero();         ///< of the IMU origin [m/s]
  Eigen::Vector3d angular_velocity_imu = Eigen::Vector3d::Zero();  ///< bias removed [rad/s]
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();             ///< [rad/s]
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();            ///< [m/s^2]
  Eigen::Vector3d gravity_odom = Eigen::Vector3d::Zero();          ///< [m/s^2]
  double accel_scale = 1.0;  ///< accelerometer readings times this are m/s^2
  /// x y z rx ry rz; translation and rotation both expressed in odom axes [m^2, rad^2].
  Matrix6d pose_covariance = Matrix6d::Zero();
  /// vx vy vz (imu axes) wx wy wz (imu axes) [(m/s)^2, (rad/s)^2].
  Matrix6d twist_covariance = Matrix6d::Zero();
};

enum class ScanStatus {
  kInitializing,  ///< not started yet, `reason` says what is waited for
  kTracking,      ///< pose corrected by the scan
  kImuOnly,       ///< scan unusable (empty, too few matches); pose is the prediction
  kDropped        ///< scan older than the state or without any IMU; no pose
};

const char* ToString(ScanStatus status);

/// Durations of one scan's stages [ms].
struct ScanTiming {
  double preprocess_ms = 0.0;  ///< decoding, propagation, deskew and downsampling
  double update_ms = 0.0;      ///< association and iterated update
  double map_ms = 0.0;         ///< insertion, subdivision, merging
  double total_ms() const { return preprocess_ms + update_ms + map_ms; }
};

/// Outcome of the iterated update.
struct UpdateSummary {
  int iterations = 0;
  bool converged = false;
  std::size_t residuals = 0;  ///< accepted in the last iteration
  std::size_t planar = 0;     ///< of which against planes, the rest against Gaussians
  double mean_abs_residual_m = 0.0;
  /// Unit directions (odom axes for translation, imu axes for rotation) that the scan could not
  /// observe; the LiDAR did not correct them.
  std::vector<Eigen::Vector3d> degenerate_translation;
  std::vector<Eigen::Vector3d> degenerate_rotation;

  bool degenerate() const {
    return !degenerate_translation.empty() || !degenerate_rotation.empty();
  }
};

/// Everything that is known after one scan.
struct ScanResult {
  ScanStatus status = ScanStatus::kInitializing;
  std::string reason;  ///< empty when tracking; one line otherwise
  OdometryEstimate estimate;
  UpdateSummary update;
  ScanTiming timing;
  std::size_t voxels = 0;     ///< root voxels in the map
  std::uint32_t segment = 0;  ///< grows when the map is dropped or the clock jumps
  Time scan_start;
  std::chrono::steady_clock::time_point arrival;  ///< of the scan, on the clock of the machine
  /// Deskewed points in the IMU frame at the scan end; Point::time keeps the firing time. Shared so
  /// that publishing threads may hold on to it.
  std::shared_ptr<const std::vector<Point>> deskewed;
};

}  // namespace hv::lio
