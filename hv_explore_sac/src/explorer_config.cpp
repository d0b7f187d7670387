#include "hv_explore_sac/explorer_config.h"

#include <algorithm>
#include <cmath>

namespace hv::explore {
namespace {

/// Planners that need no true map.
std::vector<std::string> PlannersOfRobots() {
  std::vector<std::string> names = PlannerNames();
  names.erase(std::remove(names.begin(), names.end(), "oracle"), names.end());
  names.emplace_back(kLearnedPlanner);
  return names;
}

std::string Listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

}  // namespace

void PlacesConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("frontier_m", frontier_m, "edge of the blocks that frontiers are made of [m]");
  visitor.Field("spacing_m", spacing_m, "between viewpoints [m]");
  visitor.Field("neighbors", neighbors, "nearest viewpoints that edges may lead to");
  visitor.Field("view_range_m", view_range_m, "from which frontier points are observable [m]");
  visitor.Field("min_utility", min_utility, "fewer observable frontier points count as none");
  visitor.Field("new_side_deg", new_side_deg,
                "around a frontier point that the robot has been as near to, from where a look may "
                "show more; 0: from everywhere [deg]");
  visitor.Field("margin_m", margin_m,
                "kept free around the largest circle in the footprint of the robot [m]");
  visitor.Field("only_gates", only_gates,
                "frontiers count only where the robot can drive on, on the grid");
  visitor.Field("min_unseen_m2", min_unseen_m2,
                "of ground in one piece that must be unseen behind a gate, with only_gates [m^2]");
}

void PlacesConfig::Validate(ConfigProblems& problems) const {
  problems.Require(frontier_m > 0.0 && frontier_m <= 5.0, "places.frontier_m", "must be 0 to 5");
  problems.Require(spacing_m >= 0.2 && spacing_m <= 20.0, "places.spacing_m", "must be 0.2 to 20");
  problems.Require(neighbors >= 4 && neighbors <= 100, "places.neighbors", "must be 4 to 100");
  problems.Require(view_range_m >= spacing_m && view_range_m <= 100.0, "places.view_range_m",
                   "must be spacing_m to 100");
  problems.Require(min_utility >= 1, "places.min_utility", "must be at least 1");
  problems.Require(new_side_deg >= 0.0 && new_side_deg <= 180.0, "places.new_side_deg",
                   "must be 0 to 180");
  problems.Require(margin_m >= 0.0 && margin_m <= 1.0, "places.margin_m", "must be 0 to 1");
  problems.Require(min_unseen_m2 >= 0.0, "places.min_unseen_m2", "must not be negative");
}

void ChoiceConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("planner", planner, "nearest, utility, ratio, tour, branch or sac: chooses goals");
  visitor.Field("weights", weights, "of the planner sac: a policy.bin of hv_explore_train, path");
  visitor.Field("utility_decay", utility_decay, "of the utility with the way [1/m]");
  visitor.Field("branch_decay", branch_decay, "of the utility along a branch [1/m]");
  visitor.Field("keep_goal", keep_goal, "how many times better another goal must be");
  visitor.Field("tour_samples", tour_samples, "set covers that are tried for each tour");
  visitor.Field("period_s", period_s, "of decisions on the way to a goal [s]");
  visitor.Field("insist", insist, "decisions in a row for other goals that change the goal");
}

void ChoiceConfig::Validate(ConfigProblems& problems) const {
  const std::vector<std::string> names = PlannersOfRobots();
  problems.Require(std::find(names.begin(), names.end(), planner) != names.end(), "choice.planner",
                   "must be one of " + Listed(names));
  problems.Require(planner != kLearnedPlanner || !weights.empty(), "choice.weights",
                   "must name the file of weights that the planner sac needs");
  problems.Require(utility_decay >= 0.0, "choice.utility_decay", "must not be negative");
  problems.Require(branch_decay >= 0.0, "choice.branch_decay", "must not be negative");
  problems.Require(keep_goal >= 1.0, "choice.keep_goal", "must be at least 1");
  problems.Require(tour_samples >= 1, "choice.tour_samples", "must be at least 1");
  problems.Require(period_s > 0.0, "choice.period_s", "must be positive");
  problems.Require(insist >= 1, "choice.insist", "must be at least 1");
}

void GoalsConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("reached_m", reached_m, "so near, a viewpoint has been visited [m]");
  visitor.Field("refused_radius_m", refused_radius_m,
                "viewpoints so near to a goal that failed are left alone too [m]");
  visitor.Field("refused_for_s", refused_for_s, "time for which they are left alone [s]");
  visitor.Field("failures", failures, "goals that fail in a row, after which it ends");
  visitor.Field("stuck_s", stuck_s, "without getting on, after which a goal has failed [s]");
  visitor.Field("stuck_m", stuck_m, "that count as getting on [m]");
  visitor.Field("settle_s", settle_s, "for which nothing to explore must be left at the end [s]");
  visitor.Field("inputs_lost_s", inputs_lost_s, "without map or place, after which it ends [s]");
  visitor.Field("home_tries", home_tries, "goals that are sent for the way home");
}

void GoalsConfig::Validate(ConfigProblems& problems) const {
  problems.Require(reached_m > 0.0, "goals.reached_m", "must be positive");
  problems.Require(refused_radius_m >= 0.0, "goals.refused_radius_m", "must not be negative");
  problems.Require(refused_for_s > 0.0, "goals.refused_for_s", "must be positive");
  problems.Require(failures >= 1, "goals.failures", "must be at least 1");
  problems.Require(stuck_s > 0.0, "goals.stuck_s", "must be positive");
  problems.Require(stuck_m > 0.0, "goals.stuck_m", "must be positive");
  problems.Require(settle_s >= 0.0, "goals.settle_s", "must not be negative");
  problems.Require(inputs_lost_s > 0.0, "goals.inputs_lost_s", "must be positive");
  problems.Require(home_tries >= 1, "goals.home_tries", "must be at least 1");
}

void ExplorerConfig::Describe(ConfigVisitor& visitor) {
  visitor.Section("places", places, "frontiers and viewpoints");
  visitor.Section("choice", choice, "how the next goal is chosen");
  visitor.Section("goals", goals, "when goals have been reached or failed, and when it ends");
  visitor.Section("online_learning", online_learning, "learning beside the exploration");
}

void ExplorerConfig::Validate(ConfigProblems& problems) const {
  places.Validate(problems);
  choice.Validate(problems);
  goals.Validate(problems);
  online_learning.Validate(problems);
  problems.Require(!online_learning.enabled || choice.planner == kLearnedPlanner,
                   "online_learning.enabled", "needs choice.planner sac");
}

ExplorationConfig ExplorerConfig::InCells(double cell_m) const {
  ExplorationConfig cells;
  cells.frontier.block =
      std::clamp(static_cast<int>(std::lround(places.frontier_m / cell_m)), 1, 100);
  cells.viewpoint.spacing_x = std::max(1.0, places.spacing_m / cell_m);
  cells.viewpoint.spacing_y = cells.viewpoint.spacing_x;
  cells.viewpoint.neighbors = places.neighbors;
  cells.viewpoint.view_range = places.view_range_m / cell_m;
  cells.viewpoint.min_utility = places.min_utility;
  cells.viewpoint.new_side_deg = places.new_side_deg;
  return cells;
}

PlannerConfig ExplorerConfig::PlannerInCells(double cell_m) const {
  PlannerConfig cells;
  cells.utility_decay = choice.utility_decay * cell_m;
  cells.branch_decay = choice.branch_decay * cell_m;
  cells.keep_goal = choice.keep_goal;
  cells.tour_samples = choice.tour_samples;
  return cells;
}

GuardConfig ExplorerConfig::GuardInCells(double cell_m) const {
  GuardConfig cells;
  cells.refused_radius = goals.refused_radius_m / cell_m;
  cells.refused_for =
      std::max(1, static_cast<int>(std::lround(goals.refused_for_s / choice.period_s)));
  return cells;
}

void ExplorationNodeOptions::Describe(ConfigVisitor& visitor) {
  visitor.Field("map_frame", map_frame, "frame of the map and of goals");
  visitor.Field("base_frame", base_frame, "frame of the robot");
  visitor.Field("place_timeout_s", place_timeout_s,
                "age of the transform between them at which the place counts as lost [s]");
  visitor.Field("autostart", autostart, "explore from the start, without being asked to");
}

void ExplorationNodeOptions::Validate(ConfigProblems& problems) const {
  problems.Require(!map_frame.empty(), "node.map_frame", "must not be empty");
  problems.Require(!base_frame.empty(), "node.base_frame", "must not be empty");
  problems.Require(place_timeout_s > 0.0, "node.place_timeout_s", "must be positive");
}

void RobotExplorationConfig::Describe(ConfigVisitor& visitor) {
  explorer.Describe(visitor);
  visitor.Section("node", node, "how the exploration node is tied in");
}

void RobotExplorationConfig::Validate(ConfigProblems& problems) const {
  explorer.Validate(problems);
  node.Validate(problems);
}

void ExplorationNodeConfig::Describe(ConfigVisitor& visitor) {
  visitor.Section("exploration", exploration, "exploration of unknown places");
  visitor.Section("navigation", navigation, "obstacles and ways");
  for (const char* section :
       {"input", "points", "odometry", "output", "loop", "map", "mapping", "localization"}) {
    visitor.Foreign(section);
  }
}

void ExplorationNodeConfig::Validate(ConfigProblems& problems) const {
  exploration.Validate(problems);
  navigation.Validate(problems);
}

}  // namespace hv::explore
