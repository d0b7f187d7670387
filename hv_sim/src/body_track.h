#pragma once

#include <cstdint>
#include <vector>

#include "hv_core/se3.h"
#include "hv_sim/motion.h"

namespace hv::sim {

/// Where a body is put at one instant: x y z [m] roll pitch yaw [rad].
using BodyControl = Vector6d;

/// The last 0.6 s of a motion that goes on: a quintic B-spline over controls every 10 ms, so that
/// its derivatives are exact. Control k acts around k * kStep_s. Const methods are thread-safe.
class BodyTrack {
 public:
  static constexpr double kStep_s = 0.01;
  /// Controls after the one at an instant that shape it and the step after it.
  static constexpr std::int64_t kLead = 4;

  /// At rest at `control` at all times; the next one pushed keeps its number.
  void Rest(const BodyControl& control);

  void Push(const BodyControl& control);

  /// Number of the newest control; -1 at first.
  std::int64_t newest() const { return newest_; }

  /// Up to kLead - 3 steps before the newest control, and half a second back.
  MotionState At(double time_s) const;

 private:
  const BodyControl& Control(std::int64_t index) const;

  std::vector<BodyControl> ring_;
  std::int64_t newest_ = -1;
};

}  // namespace hv::sim
