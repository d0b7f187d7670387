#pragma once

#include "hv_core/config.h"
#include "hv_core/se3.h"

namespace hv::loop {

struct LoopGateConfig {
  double base_translation_m = 1.5;
  double base_rotation_deg = 8.0;
  double base_vertical_m = 0.5;
  double drift_translation = 0.02;
  double drift_rotation_deg = 0.25;
  double drift_vertical = 0.01;
  double tilt_deg = 4.0;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// How far odometry may have drifted.
struct DriftLimits {
  double translation_m = 0.0;
  double vertical_m = 0.0;
  double rotation_rad = 0.0;
  double tilt_rad = 0.0;
};

/// Which loops odometry allows: nobody drives ten metres on and is twenty metres back, and gravity
/// tells floors and slopes apart (methods section 2, consistency).
class LoopGate {
 public:
  explicit LoopGate(const LoopGateConfig& config) : config_(config) {}

  /// Most drift after `travelled_m` metres without a loop. An error of heading bends the way, so
  /// its share grows with the square of the distance.
  DriftLimits LimitsAfter(double travelled_m) const;

  /// Whether a pose in the map may be the true one of a pose that odometry predicts.
  static bool Allows(const Pose& T_map_imu, const Pose& T_map_imu_predicted,
                     const DriftLimits& limits);

 private:
  LoopGateConfig config_;
};

}  // namespace hv::loop
