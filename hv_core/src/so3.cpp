#include "hv_core/so3.h"

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace hv::so3 {
namespace {

/// Below this angle the series of each coefficient is exact to double precision.
constexpr double kSmallAngle = 1e-4;

/// (1 - cos(angle)) / angle^2 without cancellation.
double OneMinusCosine(double angle) {
  if (angle < kSmallAngle) return 0.5 - angle * angle / 24.0;
  const double half_sine = std::sin(0.5 * angle) / angle;
  return 2.0 * half_sine * half_sine;
}

}  // namespace

Eigen::Matrix3d Hat(const Eigen::Vector3d& v) {
  Eigen::Matrix3d hat;
  hat << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return hat;
}

Eigen::Matrix3d Exp(const Eigen::Vector3d& theta) {
  const double squared = theta.squaredNorm();
  const double angle = std::sqrt(squared);
  const bool small = angle < kSmallAngle;
  const double a = small ? 1.0 - squared / 6.0 : std::sin(angle) / angle;
  const double b = OneMinusCosine(angle);
  const Eigen::Matrix3d hat = Hat(theta);
  return Eigen::Matrix3d::Identity() + a * hat + b * hat * hat;
}

Eigen::Vector3d Log(const Eigen::Matrix3d& rotation) {
  Eigen::Quaterniond quaternion(rotation);
  quaternion.normalize();
  if (quaternion.w() < 0.0) quaternion.coeffs() = -quaternion.coeffs();
  const double sine = quaternion.vec().norm();
  if (sine < kSmallAngle) return (2.0 + sine * sine / 3.0) * quaternion.vec();
  return (2.0 * std::atan2(sine, quaternion.w()) / sine) * quaternion.vec();
}

Eigen::Matrix3d RightJacobian(const Eigen::Vector3d& theta) {
  const double squared = theta.squaredNorm();
  const double angle = std::sqrt(squared);
  const bool small = angle < kSmallAngle;
  const double a = OneMinusCosine(angle);
  const double b =
      small ? 1.0 / 6.0 - squared / 120.0 : (angle - std::sin(angle)) / (squared * angle);
  const Eigen::Matrix3d hat = Hat(theta);
  return Eigen::Matrix3d::Identity() - a * hat + b * hat * hat;
}

Eigen::Matrix3d RightJacobianInverse(const Eigen::Vector3d& theta) {
  const double squared = theta.squaredNorm();
  const double angle = std::sqrt(squared);
  const Eigen::Matrix3d hat = Hat(theta);
  const double b = angle < kSmallAngle ? 1.0 / 12.0 + squared / 720.0
                                       : 1.0 / squared - 0.5 / (angle * std::tan(0.5 * angle));
  return Eigen::Matrix3d::Identity() + 0.5 * hat + b * hat * hat;
}

Eigen::Matrix3d Normalize(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0.0) u.col(2) *= -1.0;
  return u * svd.matrixV().transpose();
}

}  // namespace hv::so3
