#include "hv_lio/constant_velocity.h"

#include <algorithm>
#include <cmath>

#include "hv_core/so3.h"

namespace hv::lio {
namespace {

constexpr double kLongestStride = 0.01;

}  // namespace

void ConstantVelocityConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("angular_noise", angular_noise,
                "how fast the attitude leaves constant rotation [rad/s/sqrt(Hz)]");
  visitor.Field("linear_noise", linear_noise, "how fast the velocity changes [m/s^2/sqrt(Hz)]");
  visitor.Field("initial_speed_mps", initial_speed_mps,
                "standard deviation of the velocity at the start [m/s]");
}

void ConstantVelocityConfig::Validate(ConfigProblems& problems) const {
  problems.Require(angular_noise > 0.0, "constant_velocity.angular_noise", "must be positive");
  problems.Require(linear_noise > 0.0, "constant_velocity.linear_noise", "must be positive");
  problems.Require(initial_speed_mps > 0.0, "constant_velocity.initial_speed_mps",
                   "must be positive");
}

InitialState ConstantVelocityModel::Start() const {
  InitialState initial;
  ErrorVector sigma = ErrorVector::Constant(1e-6);
  sigma.segment<3>(ErrorIndex::kPosition).setConstant(1e-3);
  sigma.segment<3>(ErrorIndex::kRotation).setConstant(1e-3);
  sigma.segment<3>(ErrorIndex::kVelocity).setConstant(config_.initial_speed_mps);
  initial.covariance = sigma.cwiseAbs2().asDiagonal();
  return initial;
}

ImuNoiseConfig ConstantVelocityModel::Noise() const {
  ImuNoiseConfig noise;
  noise.gyro_noise = config_.angular_noise;
  noise.accel_noise = config_.linear_noise;
  noise.gyro_walk = 0.0;
  noise.accel_walk = 0.0;
  return noise;
}

std::vector<ImuStep> ConstantVelocityModel::Steps(const NavState& state, double duration) const {
  std::vector<ImuStep> steps;
  if (duration <= 0.0) return steps;
  const int count = static_cast<int>(std::ceil(duration / kLongestStride));
  const double dt = duration / count;
  for (int i = 0; i < count; ++i) {
    const Eigen::Matrix3d middle = state.rotation * so3::Exp(angular_velocity_ * (i + 0.5) * dt);
    ImuStep step;
    step.angular_velocity = angular_velocity_ + state.gyro_bias;
    step.acceleration = state.accel_bias - middle.transpose() * state.gravity;
    step.dt = dt;
    steps.push_back(step);
  }
  return steps;
}

void ConstantVelocityModel::Observe(Time stamp, const Eigen::Matrix3d& rotation) {
  if (last_stamp_ && stamp > *last_stamp_) {
    angular_velocity_ = so3::Log(last_rotation_.transpose() * rotation) / (stamp - *last_stamp_);
  }
  last_stamp_ = stamp;
  last_rotation_ = rotation;
}

void ConstantVelocityModel::Clear() {
  last_stamp_.reset();
  angular_velocity_.setZero();
}

}  // namespace hv::lio
