#pragma once

#include "hv_core/config.h"
#include "hv_navigation/footprint.h"
#include "hv_navigation/global_planner.h"
#include "hv_navigation/local_planner.h"
#include "hv_navigation/motion_limits.h"

namespace hv::navigation {

/// When to plan anew, what to try when stuck, and when to give up.
struct NavigatorConfig {
  double pose_timeout_s = 0.5;
  double obstacles_timeout_s = 0.5;
  double inputs_lost_s = 30.0;
  double replan_s = 5.0;
  double retry_s = 1.0;
  double better_plan = 0.85;
  double check_ahead_m = 6.0;
  double stray_m = 0.7;
  double goal_slack_m = 0.3;
  double approach_m = 1.5;
  double goal_yaw_slack = 0.1;
  double wait_s = 3.0;
  double stuck_s = 8.0;
  double progress_m = 0.3;
  double turn_timeout_s = 12.0;
  double back_off_m = 0.3;
  int recoveries = 7;
  double give_up_s = 90.0;
  double remember_s = 60.0;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Everything that planning can be told.
struct PlanningConfig {
  Footprint footprint;
  MotionLimits limits;
  GlobalPlannerConfig global;
  LocalPlannerConfig local;
  NavigatorConfig navigator;

  /// Up to which distances to obstacles grids must tell [m].
  double NeededClearance() const;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

}  // namespace hv::navigation
