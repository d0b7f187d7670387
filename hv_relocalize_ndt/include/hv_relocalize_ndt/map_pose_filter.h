#pragma once

#include "hv_core/se3.h"
#include "hv_relocalize_ndt/localizer_config.h"

namespace hv::relocalize {

/// The pose of the robot in the map: carried by odometry, corrected by registrations, kept upright
/// by gravity (paper 4.4.1). A Kalman filter whose error is a right perturbation of the pose
/// (translation, then rotation). Not thread-safe.
class MapPoseFilter {
 public:
  explicit MapPoseFilter(const TrackingConfig& config) : config_(config) {}

  /// Starts anew at a known place.
  void Start(const Pose& T_odom_imu, const Pose& T_map_imu, const Matrix6d& covariance);

  /// Follows odometry to its newest pose, `seconds` after the last. Between two corrections its
  /// errors add up, as those of a wrong scale do: they grow with the distance, however many steps
  /// that is made of.
  void Predict(const Pose& T_odom_imu, double seconds);

  /// Squared Mahalanobis distance of a measured pose from the predicted one: six degrees of
  /// freedom.
  double Distance(const Pose& T_map_imu, const Matrix6d& covariance) const;

  /// Takes in a measured pose, then what gravity says about the tilt.
  void Correct(const Pose& T_map_imu, const Matrix6d& covariance);

  const Pose& T_map_imu() const { return T_map_imu_; }
  Pose T_map_odom() const { return T_map_imu_ * T_odom_imu_.inverse(); }
  const Matrix6d& covariance() const { return covariance_; }
  /// Standard deviation of the position [m].
  double sigma_m() const;

 private:
  void CorrectTilt();

  TrackingConfig config_;
  Pose T_odom_imu_ = Pose::Identity();
  Pose T_map_imu_ = Pose::Identity();
  Matrix6d covariance_ = Matrix6d::Identity();
  double alone_m_ = 0.0;  ///< driven since the last correction
};

}  // namespace hv::relocalize
