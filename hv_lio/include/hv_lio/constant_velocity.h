#pragma once

#include <optional>
#include <vector>

#include "hv_core/config.h"
#include "hv_lio/imu_propagation.h"
#include "hv_lio/initializer.h"

namespace hv::lio {

struct ConstantVelocityConfig {
  double angular_noise = 0.5;
  double linear_noise = 3.0;
  double initial_speed_mps = 10.0;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Stands in for the IMU when there is none: readings of a body that keeps its linear and angular
/// velocity, with noise large enough to follow real motion. Gravity is taken as -z of the first
/// pose and is not estimated.
class ConstantVelocityModel {
 public:
  explicit ConstantVelocityModel(const ConstantVelocityConfig& config) : config_(config) {}

  /// State to start from: identity pose, unknown velocity.
  InitialState Start() const;

  /// Noise to propagate the readings with.
  ImuNoiseConfig Noise() const;

  /// Readings that carry `state` over `duration` seconds.
  std::vector<ImuStep> Steps(const NavState& state, double duration) const;

  /// Learns the angular velocity from the corrected pose at `stamp`.
  void Observe(Time stamp, const Eigen::Matrix3d& rotation);
  void Clear();

 private:
  ConstantVelocityConfig config_;
  std::optional<Time> last_stamp_;
  Eigen::Matrix3d last_rotation_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d angular_velocity_ = Eigen::Vector3d::Zero();
};

}  // namespace hv::lio
