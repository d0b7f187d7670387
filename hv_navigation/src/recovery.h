#pragma once

#include "hv_navigation/local_planner.h"
#include "hv_navigation/navigator.h"

namespace hv::navigation {

/// What a robot that is stuck tries, one after the other: to forget the obstacles that it saw and
/// look again, to turn around on the spot, to back off a little. One that has got where it cannot
/// turn first goes back the way it came. Holds references.
class Recovery {
 public:
  Recovery(const NavigatorConfig& config, const LocalPlanner& local)
      : config_(config), local_(local) {}

  void Reset() {
    step_ = Step::kNone;
    tried_ = 0;
  }
  bool Active() const { return step_ != Step::kNone; }
  int tried() const { return tried_; }

  /// Begins the next of them. `cornered`: the robot has no room to turn.
  void Begin(const NavigationInput& input, bool cornered, NavigationOutput& output);

  /// One cycle; false when it is over.
  bool Run(const NavigationInput& input, NavigationOutput& output);

 private:
  enum class Step { kNone, kLookAgain, kTurn, kBackOff, kBackOut };

  std::optional<Velocity> Turn(const NavigationInput& input);
  std::optional<Velocity> BackOff(const NavigationInput& input) const;
  std::optional<Velocity> BackOut(const NavigationInput& input) const;

  const NavigatorConfig config_;
  const LocalPlanner& local_;
  Step step_ = Step::kNone;
  int tried_ = 0;
  Time begun_;
  PlanarPose from_;  ///< pose at the beginning, in the local frame
  double last_yaw_ = 0.0;
  double turned_ = 0.0;  ///< [rad]
};

}  // namespace hv::navigation
