#include "hv_loop_btc/loop_gate.h"

#include <algorithm>
#include <cmath>

#include "hv_core/angles.h"

namespace hv::loop {

void LoopGateConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("base_translation_m", base_translation_m,
                "error of a relative position that needs no drift [m]");
  visitor.Field("base_rotation_deg", base_rotation_deg, "the same for rotation [deg]");
  visitor.Field("base_vertical_m", base_vertical_m, "the same for height [m]");
  visitor.Field("drift_translation", drift_translation,
                "most drift of the position, share of the distance");
  visitor.Field("drift_rotation_deg", drift_rotation_deg, "most drift of the heading [deg/m]");
  visitor.Field("drift_vertical", drift_vertical,
                "most drift of the height, share of the distance");
  visitor.Field("tilt_deg", tilt_deg, "most error of the vertical [deg]");
}

void LoopGateConfig::Validate(ConfigProblems& problems) const {
  const auto positive = [&](double value, const char* key) {
    problems.Require(value > 0.0, std::string("gate.") + key, "must be positive");
  };
  positive(base_translation_m, "base_translation_m");
  positive(base_rotation_deg, "base_rotation_deg");
  positive(base_vertical_m, "base_vertical_m");
  positive(tilt_deg, "tilt_deg");
  problems.Require(drift_translation >= 0.0, "gate.drift_translation", "must not be negative");
  problems.Require(drift_rotation_deg >= 0.0, "gate.drift_rotation_deg", "must not be negative");
  problems.Require(drift_vertical >= 0.0, "gate.drift_vertical", "must not be negative");
}

DriftLimits LoopGate::LimitsAfter(double travelled_m) const {
  const double bend =
      0.5 * config_.drift_rotation_deg * kRadiansPerDegree * travelled_m * travelled_m;
  DriftLimits limits;
  limits.translation_m = config_.base_translation_m + config_.drift_translation * travelled_m +
                         std::min(bend, travelled_m);
  limits.vertical_m = config_.base_vertical_m + config_.drift_vertical * travelled_m;
  limits.rotation_rad =
      std::min(M_PI, (config_.base_rotation_deg + config_.drift_rotation_deg * travelled_m) *
                         kRadiansPerDegree);
  limits.tilt_rad = config_.tilt_deg * kRadiansPerDegree;
  return limits;
}

bool LoopGate::Allows(const Pose& T_map_imu, const Pose& T_map_imu_predicted,
                      const DriftLimits& limits) {
  const Eigen::Vector3d moved = T_map_imu.translation() - T_map_imu_predicted.translation();
  const Eigen::Matrix3d turn = T_map_imu.linear() * T_map_imu_predicted.linear().transpose();
  const double tilt = std::acos(std::clamp(turn(2, 2), -1.0, 1.0));
  return std::abs(moved.z()) < limits.vertical_m && moved.norm() < limits.translation_m &&
         tilt < limits.tilt_rad &&
         RotationDistance(T_map_imu, T_map_imu_predicted) < limits.rotation_rad;
}

}  // namespace hv::loop
