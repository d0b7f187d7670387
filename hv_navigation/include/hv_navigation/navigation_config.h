#pragma once

#include <string>

#include "hv_core/config.h"
#include "hv_navigation/mapping_config.h"
#include "hv_navigation/planning_config.h"

namespace hv::navigation {

/// How the navigation node is tied in; the offline tools do not use it.
struct NavigationNodeOptions {
  std::string map_frame = "map";
  double place_timeout_s = 0.6;
  double place_jump_m = 0.5;
  double place_jump_deg = 5.0;
  double map_period_s = 1.0;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Everything that navigation can be told. Section `navigation` of the configuration file.
struct NavigationConfig {
  MappingConfig mapping;
  PlanningConfig planning;
  NavigationNodeOptions node;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// What the navigation node reads of the configuration file.
struct NavigationNodeConfig {
  NavigationConfig navigation;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

}  // namespace hv::navigation
