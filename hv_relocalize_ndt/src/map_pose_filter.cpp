#include "hv_relocalize_ndt/map_pose_filter.h"

#include <cmath>

#include <Eigen/Cholesky>

#include "hv_core/angles.h"
#include "hv_core/so3.h"

namespace hv::relocalize {
namespace {

Matrix6d Symmetric(const Matrix6d& matrix) { return 0.5 * (matrix + matrix.transpose()); }

}  // namespace

void MapPoseFilter::Start(const Pose& T_odom_imu, const Pose& T_map_imu,
                          const Matrix6d& covariance) {
  T_odom_imu_ = T_odom_imu;
  T_map_imu_ = T_map_imu;
  covariance_ = Symmetric(covariance);
  alone_m_ = 0.0;
}

void MapPoseFilter::Predict(const Pose& T_odom_imu, double seconds) {
  const Pose step = T_odom_imu_.inverse() * T_odom_imu;
  T_odom_imu_ = T_odom_imu;
  T_map_imu_ = T_map_imu_ * step;
  const Matrix6d transport = se3::Adjoint(step.inverse());
  covariance_ = Symmetric(transport * covariance_ * transport.transpose());
  const double before_m = alone_m_;
  alone_m_ += step.translation().norm();
  const double grown = alone_m_ * alone_m_ - before_m * before_m;
  const double heading = config_.drift_rotation_deg * kRadiansPerDegree;
  const double tilt = config_.drift_tilt_deg * kRadiansPerDegree;
  const double position = config_.drift_translation * config_.drift_translation * grown;
  const double waiting = config_.waiting_m * config_.waiting_m * std::abs(seconds);
  covariance_.topLeftCorner<3, 3>().diagonal().array() += position + waiting;
  const Eigen::Vector3d up = T_map_imu_.linear().row(2);
  const Eigen::Matrix3d about_up = up * up.transpose();
  covariance_.bottomRightCorner<3, 3>() +=
      grown *
      (heading * heading * about_up + tilt * tilt * (Eigen::Matrix3d::Identity() - about_up));
}

double MapPoseFilter::Distance(const Pose& T_map_imu, const Matrix6d& covariance) const {
  const Vector6d innovation = se3::Log(T_map_imu_.inverse() * T_map_imu);
  return innovation.dot((covariance_ + covariance).ldlt().solve(innovation));
}

void MapPoseFilter::Correct(const Pose& T_map_imu, const Matrix6d& covariance) {
  const Vector6d innovation = se3::Log(T_map_imu_.inverse() * T_map_imu);
  const Matrix6d gain = (covariance_ + covariance).ldlt().solve(covariance_).transpose();
  T_map_imu_ = T_map_imu_ * se3::Exp(gain * innovation);
  covariance_ = Symmetric((Matrix6d::Identity() - gain) * covariance_);
  alone_m_ = 0.0;
  CorrectTilt();
}

/// Map and odometry both stand upright: their vertical is the same but for a small error.
void MapPoseFilter::CorrectTilt() {
  const Eigen::Vector3d up_by_map = T_map_imu_.linear().row(2);
  const Eigen::Vector3d up_by_odometry = T_odom_imu_.linear().row(2);
  // up_by_map = R^T z; turning the pose by Exp(phi) on the right changes it by up x phi.
  const Eigen::Vector3d innovation = up_by_odometry - up_by_map;
  Eigen::Matrix<double, 3, 6> H = Eigen::Matrix<double, 3, 6>::Zero();
  H.rightCols<3>() = so3::Hat(up_by_map);
  const double sigma = config_.tilt_sigma_deg * kRadiansPerDegree;
  const Eigen::Matrix3d noise = sigma * sigma * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d expected = H * covariance_ * H.transpose() + noise;
  const Eigen::Matrix<double, 6, 3> gain = expected.ldlt().solve(H * covariance_).transpose();
  T_map_imu_ = T_map_imu_ * se3::Exp(gain * innovation);
  covariance_ = Symmetric((Matrix6d::Identity() - gain * H) * covariance_);
}

double MapPoseFilter::sigma_m() const {
  return std::sqrt(covariance_.topLeftCorner<3, 3>().trace());
}

}  // namespace hv::relocalize
