#include "hv_lio/initializer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "hv_core/so3.h"

namespace hv::lio {
namespace {

constexpr double kStandardGravity = 9.80665;
constexpr std::size_t kFewestSamples = 10;

/// 1 when the norm of the mean acceleration looks like m/s^2, g when it looks like g; 0 when
/// neither (free fall, broken sensor).
double AccelerationScale(double norm) {
  if (norm > 0.5 * kStandardGravity && norm < 1.5 * kStandardGravity) return 1.0;
  if (norm > 0.5 && norm < 1.5) return kStandardGravity;
  return 0.0;
}

}  // namespace

void InitializerConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("static_duration_s", static_duration_s, "time at rest needed for a start [s]");
  visitor.Field("static_gyro_std", static_gyro_std,
                "standard deviation of the gyroscope below which the sensor rests [rad/s]");
  visitor.Field("static_accel_std", static_accel_std,
                "standard deviation of the accelerometer below which the sensor rests [m/s^2]");
  visitor.Field("moving_start_after_s", moving_start_after_s,
                "start in motion when the sensor has not rested for this long; 0 = never [s]");
  visitor.Field("moving_start_scans", moving_start_scans,
                "newest scans that a start in motion finds tilt and velocity from");
  visitor.Field("gravity_mps2", gravity_mps2, "norm of gravity at the place [m/s^2]");
}

void InitializerConfig::Validate(ConfigProblems& problems) const {
  problems.Require(static_duration_s > 0.0, "initialization.static_duration_s", "must be positive");
  problems.Require(static_gyro_std > 0.0, "initialization.static_gyro_std", "must be positive");
  problems.Require(static_accel_std > 0.0, "initialization.static_accel_std", "must be positive");
  problems.Require(moving_start_after_s == 0.0 || moving_start_after_s >= static_duration_s,
                   "initialization.moving_start_after_s",
                   "must be 0 or at least static_duration_s");
  problems.Require(moving_start_scans >= 3, "initialization.moving_start_scans",
                   "must be at least 3");
  problems.Require(gravity_mps2 > 9.7 && gravity_mps2 < 9.9, "initialization.gravity_mps2",
                   "must lie between 9.7 and 9.9");
}

struct Initializer::Statistics {
  Eigen::Vector3d gyro_mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_mean = Eigen::Vector3d::Zero();
  double gyro_std = 0.0;
  double accel_std = 0.0;  ///< in the sensor's own unit
  double scale = 0.0;
  std::size_t count = 0;
};

void Initializer::Add(const ImuSample& sample) {
  if (!samples_.empty() && sample.stamp <= samples_.back().stamp) return;
  samples_.push_back(sample);
  const double kept = std::max(config_.static_duration_s, config_.moving_start_after_s) + 1.0;
  while (samples_.back().stamp - samples_.front().stamp > kept) samples_.pop_front();
}

Initializer::Statistics Initializer::Summarize(double duration) const {
  Statistics statistics;
  const Time from = samples_.back().stamp - duration;
  Eigen::Vector3d gyro_squares = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_squares = Eigen::Vector3d::Zero();
  for (auto sample = samples_.rbegin(); sample != samples_.rend() && sample->stamp >= from;
       ++sample) {
    statistics.gyro_mean += sample->angular_velocity;
    statistics.accel_mean += sample->acceleration;
    gyro_squares += sample->angular_velocity.cwiseAbs2();
    accel_squares += sample->acceleration.cwiseAbs2();
    ++statistics.count;
  }
  const double count = static_cast<double>(statistics.count);
  statistics.gyro_mean /= count;
  statistics.accel_mean /= count;
  const Eigen::Vector3d gyro_variance = gyro_squares / count - statistics.gyro_mean.cwiseAbs2();
  const Eigen::Vector3d accel_variance = accel_squares / count - statistics.accel_mean.cwiseAbs2();
  statistics.gyro_std = std::sqrt(std::max(0.0, gyro_variance.maxCoeff()));
  statistics.accel_std = std::sqrt(std::max(0.0, accel_variance.maxCoeff()));
  statistics.scale = AccelerationScale(statistics.accel_mean.norm());
  return statistics;
}

std::optional<InitialState> Initializer::TryInitialize() const {
  if (samples_.size() < kFewestSamples) return std::nullopt;
  const double observed = samples_.back().stamp - samples_.front().stamp;
  if (observed < config_.static_duration_s) return std::nullopt;
  const Statistics recent = Summarize(config_.static_duration_s);
  if (recent.scale == 0.0 || recent.count < kFewestSamples) return std::nullopt;
  if (recent.gyro_std < config_.static_gyro_std &&
      recent.accel_std * recent.scale < config_.static_accel_std) {
    return MakeState(recent, false);
  }
  const bool waited =
      config_.moving_start_after_s > 0.0 && observed >= config_.moving_start_after_s;
  return waited ? std::optional<InitialState>(MakeState(recent, true)) : std::nullopt;
}

Eigen::Vector3d Initializer::MeanForceInLastFrame() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_last_sample = Eigen::Matrix3d::Identity();
  for (std::size_t i = samples_.size(); i-- > 0;) {
    sum += R_last_sample * samples_[i].acceleration;
    if (i == 0) break;
    const double dt = samples_[i].stamp - samples_[i - 1].stamp;
    const Eigen::Vector3d rate =
        0.5 * (samples_[i].angular_velocity + samples_[i - 1].angular_velocity);
    R_last_sample = R_last_sample * so3::Exp(-rate * dt);
  }
  return sum / static_cast<double>(samples_.size());
}

InitialState Initializer::MakeState(const Statistics& statistics, bool moving) const {
  InitialState initial;
  initial.moving = moving;
  initial.accel_scale = statistics.scale;
  const Eigen::Vector3d force = moving ? MeanForceInLastFrame() : statistics.accel_mean;
  const Eigen::Vector3d up = force.normalized();
  initial.state.rotation =
      Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  initial.state.gravity = Eigen::Vector3d(0.0, 0.0, -config_.gravity_mps2);
  if (!moving) initial.state.gyro_bias = statistics.gyro_mean;

  const double tilt_sigma = moving ? 0.1 : 0.005;
  const double velocity_sigma = moving ? 2.0 : 0.02;
  const double gyro_bias_sigma = moving ? 0.02 : 0.002;
  ErrorVector sigma;
  sigma.segment<3>(ErrorIndex::kPosition).setConstant(1e-3);
  sigma.segment<3>(ErrorIndex::kRotation).setConstant(1e-3);
  sigma.segment<3>(ErrorIndex::kVelocity).setConstant(velocity_sigma);
  sigma.segment<3>(ErrorIndex::kGyroBias).setConstant(gyro_bias_sigma);
  sigma.segment<3>(ErrorIndex::kAccelBias).setConstant(0.05);
  sigma.segment<2>(ErrorIndex::kGravity).setConstant(tilt_sigma);
  initial.covariance = sigma.cwiseAbs2().asDiagonal();
  return initial;
}

std::string Initializer::WaitingFor() const {
  if (samples_.size() < kFewestSamples) return "waiting for IMU samples";
  const Statistics recent = Summarize(config_.static_duration_s);
  char line[200];
  if (recent.scale == 0.0) {
    std::snprintf(line, sizeof(line),
                  "mean acceleration is %.2f: neither about 9.8 m/s^2 nor about 1 g",
                  recent.accel_mean.norm());
  } else {
    std::snprintf(line, sizeof(line),
                  "waiting for rest: gyroscope deviates by %.3f rad/s, accelerometer by %.2f m/s^2",
                  recent.gyro_std, recent.accel_std * recent.scale);
  }
  return line;
}

}  // namespace hv::lio
