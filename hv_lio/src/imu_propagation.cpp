#include "hv_lio/imu_propagation.h"

#include "hv_core/so3.h"

namespace hv::lio {

void ImuNoiseConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("gyro_noise", gyro_noise, "gyroscope noise density [rad/s/sqrt(Hz)]");
  visitor.Field("accel_noise", accel_noise, "accelerometer noise density [m/s^2/sqrt(Hz)]");
  visitor.Field("gyro_walk", gyro_walk, "gyroscope bias random walk [rad/s^2/sqrt(Hz)]");
  visitor.Field("accel_walk", accel_walk, "accelerometer bias random walk [m/s^3/sqrt(Hz)]");
  visitor.Field("gyro_limit", gyro_limit, "reading from which the gyroscope saturates [rad/s]");
  visitor.Field("accel_limit", accel_limit,
                "reading from which the accelerometer saturates [m/s^2]");
  visitor.Field("saturated_factor", saturated_factor,
                "factor on the noise densities while the sensor saturates");
  visitor.Field("gap_gyro_noise", gap_gyro_noise,
                "how fast the attitude may change while the IMU is silent [rad/s/sqrt(Hz)]");
  visitor.Field("gap_accel_noise", gap_accel_noise,
                "how fast the velocity may change while the IMU is silent [m/s^2/sqrt(Hz)]");
}

void ImuNoiseConfig::Validate(ConfigProblems& problems) const {
  problems.Require(gyro_noise > 0.0, "imu.gyro_noise", "must be positive");
  problems.Require(accel_noise > 0.0, "imu.accel_noise", "must be positive");
  problems.Require(gyro_walk >= 0.0, "imu.gyro_walk", "must not be negative");
  problems.Require(accel_walk >= 0.0, "imu.accel_walk", "must not be negative");
  problems.Require(gyro_limit > 0.0, "imu.gyro_limit", "must be positive");
  problems.Require(accel_limit > 0.0, "imu.accel_limit", "must be positive");
  problems.Require(saturated_factor >= 1.0, "imu.saturated_factor", "must be at least 1");
  problems.Require(gap_gyro_noise > 0.0, "imu.gap_gyro_noise", "must be positive");
  problems.Require(gap_accel_noise > 0.0, "imu.gap_accel_noise", "must be positive");
}

Pose MotionKnot::PoseAfter(double dt) const {
  return MakePose(Eigen::Matrix3d(rotation * so3::Exp(angular_velocity * dt)),
                  position + velocity * dt + 0.5 * dt * dt * acceleration);
}

MotionKnot PropagateState(const ImuStep& step, NavState& state) {
  MotionKnot knot;
  knot.position = state.position;
  knot.rotation = state.rotation;
  knot.velocity = state.velocity;
  knot.angular_velocity = step.angular_velocity - state.gyro_bias;
  const Eigen::Vector3d turn = knot.angular_velocity * step.dt;
  if (step.quality != ImuQuality::kMissing) {
    knot.acceleration =
        state.rotation * so3::Exp(0.5 * turn) * (step.acceleration - state.accel_bias) +
        state.gravity;
  }
  state.position += state.velocity * step.dt + 0.5 * step.dt * step.dt * knot.acceleration;
  state.velocity += knot.acceleration * step.dt;
  state.rotation = so3::Normalize(state.rotation * so3::Exp(turn));
  return knot;
}

ErrorMatrix PropagationJacobian(const ImuStep& step, const NavState& state) {
  using Index = ErrorIndex;
  const double dt = step.dt;
  const Eigen::Vector3d turn = (step.angular_velocity - state.gyro_bias) * dt;
  const Eigen::Vector3d force = step.acceleration - state.accel_bias;
  const Eigen::Matrix3d half_turn = so3::Exp(0.5 * turn);
  const Eigen::Matrix3d middle = state.rotation * half_turn;

  const Eigen::Matrix3d accel_by_rotation = -state.rotation * so3::Hat(half_turn * force);
  const Eigen::Matrix3d accel_by_gyro_bias =
      0.5 * dt * middle * so3::Hat(force) * so3::RightJacobian(0.5 * turn);
  const Eigen::Matrix<double, 3, 2> accel_by_gravity =
      -so3::Hat(state.gravity) * TangentBasis(state.gravity);

  ErrorMatrix f = ErrorMatrix::Identity();
  f.block<3, 3>(Index::kPosition, Index::kVelocity) = dt * Eigen::Matrix3d::Identity();
  f.block<3, 3>(Index::kRotation, Index::kRotation) = so3::Exp(-turn);
  f.block<3, 3>(Index::kRotation, Index::kGyroBias) = -dt * so3::RightJacobian(turn);
  if (step.quality == ImuQuality::kMissing) return f;
  for (const auto& [row, factor] : {std::pair<int, double>{Index::kPosition, 0.5 * dt * dt},
                                    std::pair<int, double>{Index::kVelocity, dt}}) {
    f.block<3, 3>(row, Index::kRotation) = factor * accel_by_rotation;
    f.block<3, 3>(row, Index::kGyroBias) = factor * accel_by_gyro_bias;
    f.block<3, 3>(row, Index::kAccelBias) = -factor * middle;
    f.block<3, 2>(row, Index::kGravity) = factor * accel_by_gravity;
  }
  return f;
}

void PropagateCovariance(const ImuStep& step, const NavState& state, const ImuNoiseConfig& noise,
                         ErrorMatrix& covariance) {
  const ErrorMatrix f = PropagationJacobian(step, state);
  const ErrorMatrix carried = f * covariance;
  covariance.noalias() = carried * f.transpose();
  const bool missing = step.quality == ImuQuality::kMissing;
  const double factor = step.quality == ImuQuality::kSaturated ? noise.saturated_factor : 1.0;
  const auto add = [&](int index, double density) {
    covariance.diagonal().segment<3>(index).array() += density * density * step.dt;
  };
  add(ErrorIndex::kRotation, missing ? noise.gap_gyro_noise : factor * noise.gyro_noise);
  add(ErrorIndex::kVelocity, missing ? noise.gap_accel_noise : factor * noise.accel_noise);
  add(ErrorIndex::kGyroBias, noise.gyro_walk);
  add(ErrorIndex::kAccelBias, noise.accel_walk);
  covariance = 0.5 * (covariance + covariance.transpose()).eval();
}

}  // namespace hv::lio
