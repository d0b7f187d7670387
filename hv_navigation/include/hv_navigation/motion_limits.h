#pragma once

#include "hv_core/config.h"

namespace hv::navigation {

/// What a differential drive can do.
struct MotionLimits {
  double max_linear_mps = 1.0;
  double max_reverse_mps = 0.2;
  double max_angular_rps = 1.5;
  double linear_acceleration_mps2 = 0.7;
  double linear_braking_mps2 = 1.0;
  double angular_acceleration_rps2 = 2.5;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

}  // namespace hv::navigation
