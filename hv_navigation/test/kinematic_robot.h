#pragma once

#include <algorithm>
#include <cmath>

#include "hv_navigation/footprint.h"
#include "hv_navigation/motion_limits.h"
#include "hv_navigation/planar.h"

namespace hv::navigation {

/// A differential drive that does what it is told as fast as its limits allow.
class KinematicRobot {
 public:
  KinematicRobot(const PlanarPose& pose, const MotionLimits& limits)
      : pose_(pose), limits_(limits) {}

  const PlanarPose& pose() const { return pose_; }
  const Velocity& velocity() const { return velocity_; }

  void Drive(const Velocity& command, double duration_s) {
    constexpr double kStep_s = 0.01;
    const int steps = static_cast<int>(std::lround(duration_s / kStep_s));
    for (int i = 0; i < steps; ++i) {
      const double linear = std::abs(command.linear_mps) > std::abs(velocity_.linear_mps)
                                ? limits_.linear_acceleration_mps2
                                : limits_.linear_braking_mps2;
      velocity_.linear_mps = Approach(velocity_.linear_mps, command.linear_mps, linear * kStep_s);
      velocity_.angular_rps = Approach(velocity_.angular_rps, command.angular_rps,
                                       limits_.angular_acceleration_rps2 * kStep_s);
      pose_.position += kStep_s * velocity_.linear_mps * pose_.Ahead();
      pose_.yaw += kStep_s * velocity_.angular_rps;
      driven_m_ += kStep_s * std::abs(velocity_.linear_mps);
    }
  }

  double driven_m() const { return driven_m_; }

 private:
  static double Approach(double now, double target, double most) {
    return now + std::clamp(target - now, -most, most);
  }

  PlanarPose pose_;
  Velocity velocity_;
  MotionLimits limits_;
  double driven_m_ = 0.0;
};

/// The robot without its margin.
inline Footprint Bare(Footprint footprint) {
  footprint.margin_m = 0.0;
  return footprint;
}

}  // namespace hv::navigation
