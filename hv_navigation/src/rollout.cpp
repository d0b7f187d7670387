#include "rollout.h"

#include <algorithm>
#include <cmath>

namespace hv::navigation {
namespace {

double Approach(double now, double target, double most) {
  return now + std::clamp(target - now, -most, most);
}

}  // namespace

Velocity Towards(const Velocity& now, const Velocity& target, const MotionLimits& limits,
                 double duration_s) {
  const bool slower = std::abs(target.linear_mps) < std::abs(now.linear_mps) ||
                      target.linear_mps * now.linear_mps < 0.0;
  const double linear = slower ? limits.linear_braking_mps2 : limits.linear_acceleration_mps2;
  return {
      Approach(now.linear_mps, target.linear_mps, linear * duration_s),
      Approach(now.angular_rps, target.angular_rps, limits.angular_acceleration_rps2 * duration_s)};
}

Velocity Braked(const Velocity& now, const MotionLimits& limits, double duration_s) {
  const double linear_s = std::abs(now.linear_mps) / limits.linear_braking_mps2;
  const double angular_s = std::abs(now.angular_rps) / limits.angular_acceleration_rps2;
  const double stop_s = std::max(linear_s, angular_s);
  const double left = stop_s <= duration_s ? 0.0 : 1.0 - duration_s / stop_s;
  return {left * now.linear_mps, left * now.angular_rps};
}

PlanarPose Driven(const PlanarPose& pose, const Velocity& velocity, double duration_s) {
  const double turn = velocity.angular_rps * duration_s;
  const double length_m = velocity.linear_mps * duration_s;
  // The chord of the arc.
  const double half = 0.5 * turn;
  const double chord_m = std::abs(half) > 1e-6 ? length_m * std::sin(half) / half : length_m;
  const PlanarPose middle{pose.position, pose.yaw + half};
  return {pose.position + chord_m * middle.Ahead(), pose.yaw + turn};
}

}  // namespace hv::navigation
