#pragma once

#include <optional>

#include "hv_navigation/planar.h"

namespace hv::navigation {

/// Decides what goes out on cmd_vel: all while a goal is pursued, then the way to a stand and a few
/// zeros, then nothing, so that somebody else can drive. Not thread-safe.
class CommandGate {
 public:
  /// `wanted`: of this cycle; without a goal it brakes.
  std::optional<Velocity> Next(bool pursuing, const Velocity& wanted);

  /// What was sent last.
  const Velocity& last() const { return last_; }

 private:
  bool open_ = false;
  int zeros_left_ = 0;
  int braking_left_ = 0;
  Velocity last_;
};

}  // namespace hv::navigation
