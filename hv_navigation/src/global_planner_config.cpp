#include "hv_navigation/global_planner.h"

namespace hv::navigation {

void GlobalPlannerConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("samples", samples,
                "poses that RRT* draws beyond those of the route over the grid");
  visitor.Field("seed", seed, "of the random numbers");
  visitor.Field("range_m", range_m, "longest edge of the tree [m]");
  visitor.Field("tube_m", tube_m, "spread of the samples around the route over the grid [m]");
  visitor.Field("uniform_share", uniform_share, "share of the samples drawn anywhere, 0 to 1");
  visitor.Field("soft_clearance_m", soft_clearance_m,
                "distance from obstacles, beyond what the robot needs, that is worth a detour [m]");
  visitor.Field("clearance_weight", clearance_weight,
                "what a metre close to an obstacle costs more than a free one");
  visitor.Field("turn_cost_m", turn_cost_m, "metres that a turn by a radian costs");
  visitor.Field("max_detour", max_detour,
                "longest path, as a multiple of the shortest way over the grid");
  visitor.Field("start_slack_m", start_slack_m,
                "how far the robot may stand in an obstacle and still leave it [m]");
  visitor.Field("corner_radius_m", corner_radius_m, "of the arcs that round corners [m]");
  visitor.Field("path_step_m", path_step_m, "between the poses of a path [m]");
  visitor.Field("lattice_expansions", lattice_expansions,
                "effort of the search with headings, where the way is narrow");
}

void GlobalPlannerConfig::Validate(ConfigProblems& problems) const {
  const auto require = [&](bool condition, const char* key, const char* what) {
    problems.Require(condition, std::string("global.") + key, what);
  };
  require(samples >= 10, "samples", "must be at least 10");
  require(seed >= 0, "seed", "must not be negative");
  require(range_m > 0.0, "range_m", "must be positive");
  require(tube_m > 0.0, "tube_m", "must be positive");
  require(uniform_share >= 0.0 && uniform_share <= 0.9, "uniform_share",
          "must lie between 0 and 0.9");
  require(soft_clearance_m > 0.0, "soft_clearance_m", "must be positive");
  require(clearance_weight >= 0.0 && clearance_weight <= 5.0, "clearance_weight",
          "must lie between 0 and 5");
  require(turn_cost_m >= 0.0, "turn_cost_m", "must not be negative");
  require(max_detour >= 1.0, "max_detour", "must be at least 1");
  require(start_slack_m >= 0.0, "start_slack_m", "must not be negative");
  require(corner_radius_m >= 0.0, "corner_radius_m", "must not be negative");
  require(path_step_m > 0.0, "path_step_m", "must be positive");
  require(lattice_expansions >= 0, "lattice_expansions", "must not be negative");
}

}  // namespace hv::navigation
