#include "hv_loop_btc/odometry_edge.h"

#include <string>

#include <Eigen/Eigenvalues>

#include "hv_core/angles.h"

namespace hv::loop {
namespace {

/// The symmetric matrix with the absolute values of the eigenvalues.
Matrix6d AbsoluteValue(const Matrix6d& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(symmetric);
  return solver.eigenvectors() * solver.eigenvalues().cwiseAbs().asDiagonal() *
         solver.eigenvectors().transpose();
}

Matrix6d Diagonal(double translation_variance, double rotation_variance) {
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(translation_variance),
      Eigen::Vector3d::Constant(rotation_variance);
  return variances.asDiagonal();
}

/// Floor per keyframe and random walk over the distance.
Matrix6d DriftCovariance(const OdometryEdgeConfig& config, double distance) {
  const auto variance = [distance](double sigma, double drift) {
    return sigma * sigma + drift * drift * distance;
  };
  const double per_degree = kRadiansPerDegree * kRadiansPerDegree;
  return Diagonal(variance(config.translation_sigma_m, config.translation_drift_m),
                  variance(config.rotation_sigma_deg, config.rotation_drift_deg) * per_degree);
}

/// Variance along the directions that `keyframe` could not observe, in IMU axes of `to`.
Matrix6d DegenerateCovariance(const OdometryEdgeConfig& config, const Keyframe& keyframe,
                              const Keyframe& to) {
  const double translation_variance =
      config.degenerate_translation_m * config.degenerate_translation_m;
  const double rotation_sigma = kRadiansPerDegree * config.degenerate_rotation_deg;
  const Eigen::Matrix3d R_to_odom = to.T_odom_imu.linear().transpose();
  Matrix6d covariance = Matrix6d::Zero();
  for (const Eigen::Vector3d& direction_odom : keyframe.degenerate_translation) {
    const Eigen::Vector3d direction = R_to_odom * direction_odom;
    covariance.topLeftCorner<3, 3>() += translation_variance * direction * direction.transpose();
  }
  for (const Eigen::Vector3d& direction_imu : keyframe.degenerate_rotation) {
    const Eigen::Vector3d direction = R_to_odom * (keyframe.T_odom_imu.linear() * direction_imu);
    covariance.bottomRightCorner<3, 3>() +=
        rotation_sigma * rotation_sigma * direction * direction.transpose();
  }
  return covariance;
}

}  // namespace

void OdometryEdgeConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("correlation", correlation,
                "share of the front end's variance that consecutive keyframes have in common");
  visitor.Field("translation_sigma_m", translation_sigma_m,
                "added standard deviation of an edge, translation [m]");
  visitor.Field("rotation_sigma_deg", rotation_sigma_deg,
                "added standard deviation of an edge, rotation [deg]");
  visitor.Field("translation_drift_m", translation_drift_m,
                "added random walk of translation [m/sqrt(m)]");
  visitor.Field("rotation_drift_deg", rotation_drift_deg,
                "added random walk of rotation [deg/sqrt(m)]");
  visitor.Field("degenerate_translation_m", degenerate_translation_m,
                "added standard deviation along translations that the scans cannot observe [m]");
  visitor.Field("degenerate_rotation_deg", degenerate_rotation_deg,
                "added standard deviation about axes that the scans cannot observe [deg]");
}

void OdometryEdgeConfig::Validate(ConfigProblems& problems) const {
  problems.Require(correlation >= 0.0 && correlation <= 1.0, "odometry_edge.correlation",
                   "must lie between 0 and 1");
  problems.Require(translation_sigma_m > 0.0, "odometry_edge.translation_sigma_m",
                   "must be positive");
  problems.Require(rotation_sigma_deg > 0.0, "odometry_edge.rotation_sigma_deg",
                   "must be positive");
  problems.Require(translation_drift_m >= 0.0, "odometry_edge.translation_drift_m",
                   "must not be negative");
  problems.Require(rotation_drift_deg >= 0.0, "odometry_edge.rotation_drift_deg",
                   "must not be negative");
  problems.Require(degenerate_translation_m >= 0.0, "odometry_edge.degenerate_translation_m",
                   "must not be negative");
  problems.Require(degenerate_rotation_deg >= 0.0, "odometry_edge.degenerate_rotation_deg",
                   "must not be negative");
}

Matrix6d RightCovariance(const Keyframe& keyframe) {
  Matrix6d to_imu = Matrix6d::Zero();
  to_imu.topLeftCorner<3, 3>() = keyframe.T_odom_imu.linear().transpose();
  to_imu.bottomRightCorner<3, 3>() = to_imu.topLeftCorner<3, 3>();
  return to_imu * keyframe.covariance * to_imu.transpose();
}

Matrix6d RelativeCovariance(const Pose& T_from_to, const Matrix6d& sigma_from,
                            const Matrix6d& sigma_to, double correlation) {
  const Matrix6d adjoint = se3::Adjoint(T_from_to.inverse());
  const Matrix6d transported = adjoint * sigma_from * adjoint.transpose();
  return (1.0 - correlation) * (transported + sigma_to) +
         correlation * AbsoluteValue(sigma_to - transported);
}

GraphEdge OdometryEdge(const OdometryEdgeConfig& config, const Keyframe& from, const Keyframe& to) {
  if (from.segment != to.segment) {
    throw InputError("odometry edge " + std::to_string(from.id) + " -> " + std::to_string(to.id) +
                     ": the odometry started anew in between");
  }
  GraphEdge edge;
  edge.kind = EdgeKind::kOdometry;
  edge.from = from.id;
  edge.to = to.id;
  edge.T_from_to = from.T_odom_imu.inverse() * to.T_odom_imu;
  const Matrix6d covariance = RelativeCovariance(edge.T_from_to, RightCovariance(from),
                                                 RightCovariance(to), config.correlation) +
                              DriftCovariance(config, edge.T_from_to.translation().norm()) +
                              0.5 * DegenerateCovariance(config, from, to) +
                              0.5 * DegenerateCovariance(config, to, to);
  const Matrix6d information = covariance.inverse();
  edge.information = 0.5 * (information + information.transpose());
  return edge;
}

Eigen::Vector3d UpInImu(const Keyframe& keyframe) {
  return keyframe.T_odom_imu.linear().transpose() * -keyframe.gravity_odom.normalized();
}

}  // namespace hv::loop
