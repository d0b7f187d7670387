#pragma once

#include <cstdint>
#include <random>

#include <Eigen/Core>

#include "hv_core/config.h"
#include "hv_core/imu_sample.h"
#include "hv_sim/motion.h"

namespace hv::sim {

/// Standard gravity, along -z of the world [m/s^2].
inline constexpr double kGravity = 9.80665;

/// Errors of an IMU. Densities are continuous-time: a sample at rate f has a standard deviation of
/// density * sqrt(f). The bias walks are what such sensors really do within minutes; filters are
/// usually given larger ones.
struct ImuConfig {
  double rate_hz = 400.0;
  double gyro_noise = 1.9e-4;         ///< [rad/s/sqrt(Hz)]
  double accel_noise = 1.32e-3;       ///< [m/s^2/sqrt(Hz)]
  double gyro_bias_walk = 1e-5;       ///< [rad/s/sqrt(s)]
  double accel_bias_walk = 1e-4;      ///< [m/s^2/sqrt(s)]
  double gyro_bias_sigma = 3e-3;      ///< spread of the initial bias per axis [rad/s]
  double accel_bias_sigma = 3e-2;     ///< spread of the initial bias per axis [m/s^2]
  double gyro_range = 0.0;            ///< readings saturate here [rad/s], 0: never
  double accel_range = 0.0;           ///< readings saturate here [m/s^2], 0: never
  double gyro_resolution = 0.0;       ///< quantisation step [rad/s], 0: none
  double accel_resolution = 0.0;      ///< quantisation step [m/s^2], 0: none
  bool noise = true;                  ///< false: no noise and no bias

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// What a perfect IMU reads when its own frame moves as `imu` (see Attached()).
ImuSample IdealImu(Time stamp, const MotionState& imu);

/// Adds bias, noise, saturation and quantisation to ideal readings. Call once per sample, in order
/// of time; not thread-safe. The result depends on the configuration and the seed only.
class ImuSimulator {
 public:
  ImuSimulator(const ImuConfig& config, std::uint32_t seed);

  ImuSample Measure(const ImuSample& ideal);

  const Eigen::Vector3d& gyro_bias() const { return gyro_bias_; }
  const Eigen::Vector3d& accel_bias() const { return accel_bias_; }

 private:
  Eigen::Vector3d Gaussian(double sigma);

  ImuConfig config_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  Eigen::Vector3d gyro_bias_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias_ = Eigen::Vector3d::Zero();
};

}  // namespace hv::sim
