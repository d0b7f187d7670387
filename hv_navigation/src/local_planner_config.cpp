#include "hv_navigation/local_planner.h"

namespace hv::navigation {

void LocalPlannerConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("period_s", period_s, "of the control cycle [s]");
  visitor.Field("reaction_s", reaction_s, "delay of the robot that is allowed for [s]");
  visitor.Field("horizon_s", horizon_s, "how far ahead velocities are simulated [s]");
  visitor.Field("step_s", step_s, "of the simulation [s]");
  visitor.Field("speeds", speeds, "speeds that are tried");
  visitor.Field("turns", turns, "rates of turning that are tried");
  visitor.Field("look_ahead_m", look_ahead_m, "along the path to the point aimed at [m]");
  visitor.Field("turn_from", turn_from,
                "angle to that point from which the robot turns on the spot [rad]");
  visitor.Field("turn_until", turn_until, "and down to which [rad]");
  visitor.Field("goal_tolerance_m", goal_tolerance_m, "distance from the goal [m]");
  visitor.Field("goal_yaw_tolerance", goal_yaw_tolerance, "and angle [rad]");
  visitor.Field("approach_mps2", approach_mps2, "braking before stops of the path [m/s^2]");
  visitor.Field("slow_mps", slow_mps, "speed where the robot just fits [m/s]");
  visitor.Field("slow_clearance_m", slow_clearance_m,
                "distance from obstacles, beyond what the robot needs, for full speed [m]");
  visitor.Field("margin_slack_m", margin_slack_m,
                "how far the robot may stand in an obstacle and still leave it [m]");
  visitor.Field("progress_weight", progress_weight, "of getting on along the path");
  visitor.Field("path_weight", path_weight, "of the distance from the path [1/m]");
  visitor.Field("heading_weight", heading_weight, "of the angle to the path [1/rad]");
  visitor.Field("clearance_weight", clearance_weight, "of the nearness of obstacles");
  visitor.Field("smoothness_weight", smoothness_weight, "of changes of the velocity");
  visitor.Field("collision_weight", collision_weight, "of obstacles before the horizon");
}

void LocalPlannerConfig::Validate(ConfigProblems& problems) const {
  const auto require = [&](bool condition, const char* key, const char* what) {
    problems.Require(condition, std::string("local.") + key, what);
  };
  const auto positive = [&](double value, const char* key) {
    require(value > 0.0, key, "must be positive");
  };
  positive(period_s, "period_s");
  positive(horizon_s, "horizon_s");
  positive(step_s, "step_s");
  positive(look_ahead_m, "look_ahead_m");
  positive(goal_tolerance_m, "goal_tolerance_m");
  positive(goal_yaw_tolerance, "goal_yaw_tolerance");
  positive(approach_mps2, "approach_mps2");
  positive(slow_mps, "slow_mps");
  positive(slow_clearance_m, "slow_clearance_m");
  require(reaction_s >= 0.0, "reaction_s", "must not be negative");
  require(margin_slack_m >= 0.0, "margin_slack_m", "must not be negative");
  require(speeds >= 1, "speeds", "must be at least 1");
  require(turns >= 3, "turns", "must be at least 3");
  require(turn_until > 0.0 && turn_until < turn_from, "turn_until",
          "must lie between 0 and turn_from");
}

}  // namespace hv::navigation
