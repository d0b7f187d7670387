#include "hv_navigation/planning_config.h"

#include <algorithm>

namespace hv::navigation {

void NavigatorConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("pose_timeout_s", pose_timeout_s, "age of the pose at which the robot stops [s]");
  visitor.Field("obstacles_timeout_s", obstacles_timeout_s,
                "age of the obstacle sensors' data at which it stops [s]");
  visitor.Field("inputs_lost_s", inputs_lost_s,
                "time without pose, place or sensors after which the goal is given up [s]");
  visitor.Field("replan_s", replan_s, "between plans while all is well [s]");
  visitor.Field("retry_s", retry_s, "between plans while the path is blocked [s]");
  visitor.Field("better_plan", better_plan,
                "share of the present plan's cost at which a new one is taken");
  visitor.Field("check_ahead_m", check_ahead_m, "of the path that is checked for obstacles [m]");
  visitor.Field("stray_m", stray_m, "distance from the path at which a new one is planned [m]");
  visitor.Field("goal_slack_m", goal_slack_m, "how far a goal may be moved that is not free [m]");
  visitor.Field("approach_m", approach_m,
                "how near to a goal that is in an obstacle it goes to look again [m]");
  visitor.Field("goal_yaw_slack", goal_yaw_slack, "and how far turned; from pi on any [rad]");
  visitor.Field("wait_s", wait_s, "for something to get out of the way, before recovery [s]");
  visitor.Field("stuck_s", stuck_s, "time without progress after which recovery begins [s]");
  visitor.Field("progress_m", progress_m, "along the path that counts as progress [m]");
  visitor.Field("turn_timeout_s", turn_timeout_s, "for looking around [s]");
  visitor.Field("back_off_m", back_off_m, "distance to back off [m]");
  visitor.Field("recoveries", recoveries, "tried without progress before giving up");
  visitor.Field("give_up_s", give_up_s, "time without progress before giving up [s]");
  visitor.Field("remember_s", remember_s,
                "how long what blocked a path is minded out of sight [s]");
}

void NavigatorConfig::Validate(ConfigProblems& problems) const {
  const auto require = [&](bool condition, const char* key, const char* what) {
    problems.Require(condition, std::string("navigator.") + key, what);
  };
  const auto positive = [&](double value, const char* key) {
    require(value > 0.0, key, "must be positive");
  };
  positive(pose_timeout_s, "pose_timeout_s");
  positive(obstacles_timeout_s, "obstacles_timeout_s");
  positive(inputs_lost_s, "inputs_lost_s");
  positive(replan_s, "replan_s");
  positive(retry_s, "retry_s");
  positive(check_ahead_m, "check_ahead_m");
  positive(stray_m, "stray_m");
  positive(wait_s, "wait_s");
  positive(stuck_s, "stuck_s");
  positive(progress_m, "progress_m");
  positive(turn_timeout_s, "turn_timeout_s");
  positive(back_off_m, "back_off_m");
  positive(give_up_s, "give_up_s");
  require(remember_s >= 0.0, "remember_s", "must not be negative");
  require(better_plan > 0.0 && better_plan <= 1.0, "better_plan", "must lie between 0 and 1");
  require(goal_slack_m >= 0.0, "goal_slack_m", "must not be negative");
  require(approach_m >= 0.0, "approach_m", "must not be negative");
  require(goal_yaw_slack >= 0.0, "goal_yaw_slack", "must not be negative");
  require(recoveries >= 0, "recoveries", "must not be negative");
}

double PlanningConfig::NeededClearance() const {
  constexpr double kStride_m = 0.7;  // checks along paths take steps as long in open space
  return footprint.CircumscribedRadius() +
         std::max({global.soft_clearance_m, local.slow_clearance_m, kStride_m});
}

void PlanningConfig::Describe(ConfigVisitor& visitor) {
  visitor.Section("footprint", footprint, "the ground that the robot covers");
  visitor.Section("limits", limits, "what the robot can do");
  visitor.Section("global", global, "paths through the map");
  visitor.Section("local", local, "how a path is followed");
  visitor.Section("navigator", navigator, "from goal to result");
}

void PlanningConfig::Validate(ConfigProblems& problems) const {
  footprint.Validate(problems);
  limits.Validate(problems);
  global.Validate(problems);
  local.Validate(problems);
  navigator.Validate(problems);
  problems.Require(local.slow_mps <= limits.max_linear_mps, "local.slow_mps",
                   "must not exceed limits.max_linear_mps");
}

}  // namespace hv::navigation
