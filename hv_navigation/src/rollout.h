#pragma once

#include "hv_navigation/motion_limits.h"
#include "hv_navigation/planar.h"

namespace hv::navigation {

/// The velocity after `duration_s` on the way from `now` to `target`, within the limits.
Velocity Towards(const Velocity& now, const Velocity& target, const MotionLimits& limits,
                 double duration_s);

/// Brakes as hard as allowed along the circle driven now.
Velocity Braked(const Velocity& now, const MotionLimits& limits, double duration_s);

/// Where a robot gets that keeps its velocity for `duration_s`.
PlanarPose Driven(const PlanarPose& pose, const Velocity& velocity, double duration_s);

}  // namespace hv::navigation
