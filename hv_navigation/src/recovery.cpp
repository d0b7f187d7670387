#include "recovery.h"

#include <cmath>

namespace hv::navigation {
namespace {

constexpr double kLookAgain_s = 1.0;
constexpr double kBackOut_s = 30.0;
constexpr double kAround = 2.0 * M_PI - 0.3;  // rad

}  // namespace

void Recovery::Begin(const NavigationInput& input, bool cornered, NavigationOutput& output) {
  constexpr Step kOrder[] = {Step::kLookAgain, Step::kTurn, Step::kBackOff};
  constexpr Step kOrderCornered[] = {Step::kBackOut, Step::kLookAgain, Step::kTurn};
  step_ = (cornered ? kOrderCornered : kOrder)[tried_ % 3];
  ++tried_;
  begun_ = input.now;
  from_ = input.T_local_base;
  last_yaw_ = from_.yaw;
  turned_ = 0.0;
  output.look_again = step_ == Step::kLookAgain;
  output.recoveries = tried_;
}

bool Recovery::Run(const NavigationInput& input, NavigationOutput& output) {
  const double lasted_s = input.now - begun_;
  std::optional<Velocity> velocity;
  switch (step_) {
    case Step::kNone:
      break;
    case Step::kLookAgain:
      output.state = NavigationState::kWaiting;
      output.reason = "looks again at what is in the way";
      if (lasted_s < kLookAgain_s) velocity = output.velocity;
      break;
    case Step::kTurn:
      output.state = NavigationState::kTurning;
      output.reason = "turns to look around";
      if (lasted_s < config_.turn_timeout_s) velocity = Turn(input);
      break;
    case Step::kBackOff:
      output.state = NavigationState::kBackingOff;
      output.reason = "backs off";
      if (lasted_s < config_.turn_timeout_s) velocity = BackOff(input);
      break;
    case Step::kBackOut:
      output.state = NavigationState::kBackingOff;
      output.reason = "backs off to where it can turn";
      if (lasted_s < kBackOut_s) velocity = BackOut(input);
      break;
  }
  if (!velocity) {
    step_ = Step::kNone;
    return false;
  }
  output.velocity = *velocity;
  return true;
}

std::optional<Velocity> Recovery::Turn(const NavigationInput& input) {
  turned_ += std::abs(WrappedAngle(input.T_local_base.yaw - last_yaw_));
  last_yaw_ = input.T_local_base.yaw;
  if (turned_ >= kAround) return std::nullopt;
  return local_.Turn(AheadOf(input), input.T_local_base, input.velocity, kAround - turned_);
}

std::optional<Velocity> Recovery::BackOff(const NavigationInput& input) const {
  const double driven_m = (input.T_local_base.position - from_.position).norm();
  if (driven_m >= config_.back_off_m) return std::nullopt;
  return local_.BackOff(AheadOf(input), input.T_local_base, input.velocity);
}

std::optional<Velocity> Recovery::BackOut(const NavigationInput& input) const {
  if (local_.HasRoomToTurn(*input.local_grid, input.T_local_base)) return std::nullopt;
  return local_.BackOff(AheadOf(input), input.T_local_base, input.velocity);
}

}  // namespace hv::navigation
