#include "hv_navigation/motion_limits.h"

namespace hv::navigation {

void MotionLimits::Describe(ConfigVisitor& visitor) {
  visitor.Field("max_linear_mps", max_linear_mps, "speed ahead [m/s]");
  visitor.Field("max_reverse_mps", max_reverse_mps, "speed back, driven for recovery only [m/s]");
  visitor.Field("max_angular_rps", max_angular_rps, "rate of turning [rad/s]");
  visitor.Field("linear_acceleration_mps2", linear_acceleration_mps2, "speeding up [m/s^2]");
  visitor.Field("linear_braking_mps2", linear_braking_mps2, "slowing down [m/s^2]");
  visitor.Field("angular_acceleration_rps2", angular_acceleration_rps2,
                "change of the rate of turning [rad/s^2]");
}

void MotionLimits::Validate(ConfigProblems& problems) const {
  const auto positive = [&](double value, const char* key) {
    problems.Require(value > 0.0, std::string("limits.") + key, "must be positive");
  };
  positive(max_linear_mps, "max_linear_mps");
  positive(max_reverse_mps, "max_reverse_mps");
  positive(max_angular_rps, "max_angular_rps");
  positive(linear_acceleration_mps2, "linear_acceleration_mps2");
  positive(linear_braking_mps2, "linear_braking_mps2");
  positive(angular_acceleration_rps2, "angular_acceleration_rps2");
}

}  // namespace hv::navigation
