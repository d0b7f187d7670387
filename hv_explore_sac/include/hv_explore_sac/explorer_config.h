#pragma once

#include <string>

#include "hv_core/config.h"
#include "hv_explore_sac/exploration_config.h"
#include "hv_explore_sac/loop_guard.h"
#include "hv_explore_sac/online/online_config.h"
#include "hv_explore_sac/planner.h"
#include "hv_navigation/navigation_config.h"

namespace hv::explore {

/// Where a robot looks for what is unknown. Made for indoors; lengths are rounded to cells of the
/// map.
struct PlacesConfig {
  double frontier_m = 0.2;     ///< edge of the blocks that frontiers are made of
  double spacing_m = 0.8;      ///< between viewpoints
  int neighbors = 20;          ///< nearest viewpoints that edges may lead to
  double view_range_m = 7.0;   ///< from which a frontier point is observable
  int min_utility = 3;         ///< fewer observable frontier points count as none
  double new_side_deg = 60.0;  ///< around a frontier point, see FrontierViews
  double margin_m = 0.04;      ///< kept free around the largest circle in the footprint
  bool only_gates = false;     ///< frontiers count only where the robot can drive on, see GateRules
  double min_unseen_m2 = 0.3;  ///< of ground behind a gate

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// How the next goal is chosen.
struct ChoiceConfig {
  std::string planner = "utility";
  std::string weights;         ///< of the planner `sac`: a file of hv_explore_train
  double utility_decay = 0.2;  ///< of the utility with the way [1/m]
  double branch_decay = 0.3;   ///< the same for `branch` [1/m]
  double keep_goal = 1.1;      ///< how many times better another goal must be
  int tour_samples = 20;       ///< set covers that `tour` tries
  double period_s = 1.0;       ///< of decisions on the way
  int insist = 3;              ///< decisions in a row for other goals that change a goal

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// When goals count as reached or failed, and an exploration as ended.
struct GoalsConfig {
  double reached_m = 0.5;         ///< so near, a viewpoint has been visited
  double refused_radius_m = 1.0;  ///< viewpoints so near to a goal that failed are left alone too
  double refused_for_s = 60.0;
  int failures = 10;            ///< in a row, after which navigation counts as failing
  double stuck_s = 100.0;       ///< without getting on, after which a goal has failed
  double stuck_m = 0.5;         ///< that count as getting on
  double settle_s = 5.0;        ///< for which nothing to explore must be left
  double inputs_lost_s = 60.0;  ///< without map or place, after which it ends
  int home_tries = 3;           ///< goals sent for the way home

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Everything that an Explorer can be told.
struct ExplorerConfig {
  PlacesConfig places;
  ChoiceConfig choice;
  GoalsConfig goals;
  OnlineLearningConfig online_learning;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;

  /// What the planners are told, in cells of edge `cell_m`.
  ExplorationConfig InCells(double cell_m) const;
  PlannerConfig PlannerInCells(double cell_m) const;
  GuardConfig GuardInCells(double cell_m) const;
};

/// How the node is tied in; the offline tools do not use it.
struct ExplorationNodeOptions {
  std::string map_frame = "map";
  std::string base_frame = "base_link";
  double place_timeout_s = 2.0;  ///< age of the transform at which the place counts as lost
  bool autostart = false;        ///< explore as soon as there is a map

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Section `exploration` of the configuration file.
struct RobotExplorationConfig {
  ExplorerConfig explorer;
  ExplorationNodeOptions node;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// What the exploration node reads of the configuration file.
struct ExplorationNodeConfig {
  RobotExplorationConfig exploration;
  navigation::NavigationConfig navigation;  ///< for the footprint

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

}  // namespace hv::explore
