#pragma once

#include <cstdint>
#include <vector>

#include "hv_sim/motion.h"
#include "hv_sim/world.h"
#include "motion_spline.h"

namespace hv::sim {

/// How a carrier gets along its route.
struct PlanProfile {
  double speed = 1.2;          ///< cruising [m/s]
  double acceleration = 0.6;   ///< along the path, either sign [m/s^2]
  double yaw_rate = 0.9;       ///< highest in corners and turns on the spot [rad/s]
  double height = 1.3;         ///< of the LiDAR above the floor [m]
  double corner = 0.7;         ///< reach of rounded corners [m]
  double step_s = 0.25;        ///< between controls; longer is smoother [s]
  double stop_every = 0.0;     ///< mean distance between stops [m], 0: never stops
  double idle_activity = 0.0;  ///< liveliness while standing, after the start
  bool follows_slope = false;  ///< wheels tilt with the floor, hands do not
};

/// Controls of a MotionSpline with step `profile.step_s`, covering skip_s and duration_s.
std::vector<Controls> PlanControls(const World& world, const MotionConfig& config,
                                   const PlanProfile& profile);

}  // namespace hv::sim
