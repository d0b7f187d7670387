#include "command_gate.h"

#include <cmath>

namespace hv::navigation {
namespace {

constexpr int kZeros = 5;
constexpr int kMostBraking = 30;

bool IsZero(const Velocity& velocity) {
  constexpr double kStill = 1e-3;
  return std::abs(velocity.linear_mps) < kStill && std::abs(velocity.angular_rps) < kStill;
}

}  // namespace

std::optional<Velocity> CommandGate::Next(bool pursuing, const Velocity& wanted) {
  if (pursuing) {
    open_ = true;
    zeros_left_ = kZeros;
    braking_left_ = kMostBraking;
    last_ = wanted;
    return last_;
  }
  if (!open_) return std::nullopt;
  const bool brakes = !IsZero(wanted) && !IsZero(last_) && braking_left_-- > 0;
  last_ = brakes ? wanted : Velocity();
  if (!brakes && --zeros_left_ <= 0) open_ = false;
  return last_;
}

}  // namespace hv::navigation
