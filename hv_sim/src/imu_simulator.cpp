#include "hv_sim/imu_simulator.h"

#include <algorithm>
#include <cmath>

namespace hv::sim {
namespace {

/// What a converter makes of `value`: clipped to +-range, rounded to its resolution.
Eigen::Vector3d Digitise(Eigen::Vector3d value, double range, double resolution) {
  for (int axis = 0; axis < 3; ++axis) {
    if (range > 0.0) value[axis] = std::clamp(value[axis], -range, range);
    if (resolution > 0.0) value[axis] = std::round(value[axis] / resolution) * resolution;
  }
  return value;
}

}  // namespace

void ImuConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("rate_hz", rate_hz, "samples per second [Hz]");
  visitor.Field("gyro_noise", gyro_noise, "noise density [rad/s/sqrt(Hz)]");
  visitor.Field("accel_noise", accel_noise, "noise density [m/s^2/sqrt(Hz)]");
  visitor.Field("gyro_bias_walk", gyro_bias_walk, "random walk of the bias [rad/s/sqrt(s)]");
  visitor.Field("accel_bias_walk", accel_bias_walk, "random walk of the bias [m/s^2/sqrt(s)]");
  visitor.Field("gyro_bias_sigma", gyro_bias_sigma, "spread of the initial bias [rad/s]");
  visitor.Field("accel_bias_sigma", accel_bias_sigma, "spread of the initial bias [m/s^2]");
  visitor.Field("gyro_range", gyro_range, "saturation [rad/s], 0: none");
  visitor.Field("accel_range", accel_range, "saturation [m/s^2], 0: none");
  visitor.Field("gyro_resolution", gyro_resolution, "quantisation step [rad/s], 0: none");
  visitor.Field("accel_resolution", accel_resolution, "quantisation step [m/s^2], 0: none");
  visitor.Field("noise", noise, "false: neither noise nor bias");
}

void ImuConfig::Validate(ConfigProblems& problems) const {
  problems.Require(rate_hz >= 1.0 && rate_hz <= 1e5, "rate_hz", "must be in [1, 1e5]");
  const auto not_negative = [&problems](const char* key, double value) {
    problems.Require(value >= 0.0, key, "must not be negative");
  };
  not_negative("gyro_noise", gyro_noise);
  not_negative("accel_noise", accel_noise);
  not_negative("gyro_bias_walk", gyro_bias_walk);
  not_negative("accel_bias_walk", accel_bias_walk);
  not_negative("gyro_bias_sigma", gyro_bias_sigma);
  not_negative("accel_bias_sigma", accel_bias_sigma);
  not_negative("gyro_range", gyro_range);
  not_negative("accel_range", accel_range);
  not_negative("gyro_resolution", gyro_resolution);
  not_negative("accel_resolution", accel_resolution);
}

ImuSample IdealImu(Time stamp, const MotionState& imu) {
  const Eigen::Vector3d gravity(0.0, 0.0, -kGravity);
  ImuSample sample;
  sample.stamp = stamp;
  sample.angular_velocity = imu.angular_velocity;
  sample.acceleration = imu.T_world_body.linear().transpose() * (imu.acceleration - gravity);
  return sample;
}

ImuSimulator::ImuSimulator(const ImuConfig& config, std::uint32_t seed)
    : config_(config), random_(seed) {
  if (!config_.noise) return;
  gyro_bias_ = Gaussian(config_.gyro_bias_sigma);
  accel_bias_ = Gaussian(config_.accel_bias_sigma);
}

Eigen::Vector3d ImuSimulator::Gaussian(double sigma) {
  const double x = normal_(random_);
  const double y = normal_(random_);
  const double z = normal_(random_);
  return sigma * Eigen::Vector3d(x, y, z);
}

ImuSample ImuSimulator::Measure(const ImuSample& ideal) {
  ImuSample sample = ideal;
  if (config_.noise) {
    const double root_rate = std::sqrt(config_.rate_hz);
    sample.angular_velocity += gyro_bias_ + Gaussian(config_.gyro_noise * root_rate);
    sample.acceleration += accel_bias_ + Gaussian(config_.accel_noise * root_rate);
    gyro_bias_ += Gaussian(config_.gyro_bias_walk / root_rate);
    accel_bias_ += Gaussian(config_.accel_bias_walk / root_rate);
  }
  sample.angular_velocity =
      Digitise(sample.angular_velocity, config_.gyro_range, config_.gyro_resolution);
  sample.acceleration =
      Digitise(sample.acceleration, config_.accel_range, config_.accel_resolution);
  return sample;
}

}  // namespace hv::sim
