#include "motion_jet.h"

namespace hv::sim {

void SetRotation(const Jet& roll, const Jet& pitch, const Jet& yaw, MotionState& state) {
  const Jet sin_roll = Sin({roll.value, roll.first, 0.0});
  const Jet cos_roll = Cos({roll.value, roll.first, 0.0});
  const Jet sin_pitch = Sin({pitch.value, pitch.first, 0.0});
  const Jet cos_pitch = Cos({pitch.value, pitch.first, 0.0});
  const Jet roll_rate{roll.first, roll.second, 0.0};
  const Jet pitch_rate{pitch.first, pitch.second, 0.0};
  const Jet yaw_rate{yaw.first, yaw.second, 0.0};
  const Jet x = roll_rate - yaw_rate * sin_pitch;
  const Jet y = pitch_rate * cos_roll + yaw_rate * cos_pitch * sin_roll;
  const Jet z = yaw_rate * cos_pitch * cos_roll - pitch_rate * sin_roll;
  state.T_world_body.linear() = RotationFromRpy(roll.value, pitch.value, yaw.value);
  state.angular_velocity = {x.value, y.value, z.value};
  state.angular_acceleration = {x.first, y.first, z.first};
}

void SetTranslation(const Jet& x, const Jet& y, const Jet& z, MotionState& state) {
  state.T_world_body.translation() = Eigen::Vector3d(x.value, y.value, z.value);
  state.velocity = {x.first, y.first, z.first};
  state.acceleration = {x.second, y.second, z.second};
}

}  // namespace hv::sim
