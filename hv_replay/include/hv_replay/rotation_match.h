#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "hv_core/imu_sample.h"
#include "hv_core/time.h"

namespace hv::replay {

/// Rotation of the LiDAR from `begin` to `end`, as a rotation vector in its own frame [rad].
struct RotationStep {
  Time begin;
  Time end;
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();
};

/// How the rotation seen by the LiDAR and that measured by the gyroscope fit each other.
struct RotationMatch {
  double offset_s = 0.0;     ///< to add to LiDAR stamps to get IMU time
  double correlation = 0.0;  ///< at that offset with the best rotation, 1 = perfect
  double gyro_scale = 1.0;   ///< gyroscope over LiDAR rotation: 1 for rad/s, 57.3 for deg/s
  Eigen::Matrix3d R_imu_lidar = Eigen::Matrix3d::Identity();  ///< best rotation
  bool all_axes = false;  ///< the motion turned about more than one axis: R is unique
  double rms_rate = 0.0;  ///< of the LiDAR [rad/s]
  std::size_t steps = 0;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< sum of gyro * lidar^T at the offset
  double norms = 0.0;                                    ///< sqrt(sum |gyro|^2 * sum |lidar|^2)

  /// Correlation when a given rotation is used instead of the best one, in [-1, 1].
  double CorrelationWith(const Eigen::Matrix3d& R_imu_lidar) const;
};

/// Finds time offset (within +-`max_offset_s`), rotation and scale between both sensors from their
/// rotations alone; constant gyroscope bias does not matter. Nullopt when there is too little
/// rotation or data to tell.
std::optional<RotationMatch> MatchRotations(const std::vector<RotationStep>& lidar,
                                            const std::vector<ImuSample>& gyro,
                                            double max_offset_s = 0.4);

}  // namespace hv::replay
