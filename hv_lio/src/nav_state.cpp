#include "hv_lio/nav_state.h"

#include <cmath>

#include "hv_core/so3.h"

namespace hv::lio {
namespace {

/// theta / sin(theta) as a function of c = cos(theta), and its derivative by c.
struct AngleRatio {
  double value = 1.0;
  double derivative = -1.0 / 3.0;
};

AngleRatio AngleOverSine(double sine, double cosine) {
  if (sine < 1e-5 && cosine > 0.0) return {1.0 + sine * sine / 6.0, -1.0 / 3.0};
  const double value = std::atan2(sine, cosine) / sine;
  return {value, (cosine * value - 1.0) / (sine * sine)};
}

/// Gravity turned by a tangent vector of its sphere [rad].
Eigen::Vector3d TurnGravity(const Eigen::Vector3d& gravity, const Eigen::Vector2d& delta) {
  return so3::Exp(TangentBasis(gravity) * delta) * gravity;
}

Eigen::Vector2d GravityDifference(const Eigen::Vector3d& to, const Eigen::Vector3d& from) {
  const Eigen::Vector3d u = from.normalized();
  const Eigen::Vector3d w = to.normalized();
  const Eigen::Vector3d s = u.cross(w);
  return TangentBasis(from).transpose() * (AngleOverSine(s.norm(), u.dot(w)).value * s);
}

Eigen::Matrix2d GravityDifferenceJacobian(const Eigen::Vector3d& to, const Eigen::Vector3d& from) {
  const Eigen::Vector3d u = from.normalized();
  const Eigen::Vector3d w = to.normalized();
  const Eigen::Vector3d s = u.cross(w);
  const AngleRatio ratio = AngleOverSine(s.norm(), u.dot(w));
  const Eigen::Matrix<double, 3, 2> w_by_delta = -so3::Hat(w) * TangentBasis(to);
  const Eigen::Matrix3d s_by_w =
      ratio.value * so3::Hat(u) + ratio.derivative * s * u.transpose();
  return TangentBasis(from).transpose() * s_by_w * w_by_delta;
}

}  // namespace

NavState NavState::Plus(const ErrorVector& delta) const {
  NavState result = *this;
  result.position += delta.segment<3>(ErrorIndex::kPosition);
  result.rotation = rotation * so3::Exp(delta.segment<3>(ErrorIndex::kRotation));
  result.velocity += delta.segment<3>(ErrorIndex::kVelocity);
  result.gyro_bias += delta.segment<3>(ErrorIndex::kGyroBias);
  result.accel_bias += delta.segment<3>(ErrorIndex::kAccelBias);
  result.gravity = TurnGravity(gravity, delta.segment<2>(ErrorIndex::kGravity));
  return result;
}

ErrorVector NavState::Minus(const NavState& other) const {
  ErrorVector delta;
  delta.segment<3>(ErrorIndex::kPosition) = position - other.position;
  delta.segment<3>(ErrorIndex::kRotation) = so3::Log(other.rotation.transpose() * rotation);
  delta.segment<3>(ErrorIndex::kVelocity) = velocity - other.velocity;
  delta.segment<3>(ErrorIndex::kGyroBias) = gyro_bias - other.gyro_bias;
  delta.segment<3>(ErrorIndex::kAccelBias) = accel_bias - other.accel_bias;
  delta.segment<2>(ErrorIndex::kGravity) = GravityDifference(gravity, other.gravity);
  return delta;
}

ErrorMatrix NavState::MinusJacobian(const NavState& other) const {
  ErrorMatrix jacobian = ErrorMatrix::Identity();
  jacobian.block<3, 3>(ErrorIndex::kRotation, ErrorIndex::kRotation) =
      so3::RightJacobianInverse(so3::Log(other.rotation.transpose() * rotation));
  jacobian.block<2, 2>(ErrorIndex::kGravity, ErrorIndex::kGravity) =
      GravityDifferenceJacobian(gravity, other.gravity);
  return jacobian;
}

Eigen::Matrix<double, 3, 2> TangentBasis(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d unit = direction.normalized();
  const Eigen::Vector3d helper =
      std::abs(unit.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) = (helper - unit * unit.dot(helper)).normalized();
  basis.col(1) = unit.cross(basis.col(0));
  return basis;
}

}  // namespace hv::lio
