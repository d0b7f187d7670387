#pragma once

#include "hv_core/config.h"
#include "hv_navigation/mapping_config.h"
#include "hv_navigation/planning_config.h"
#include "hv_replay/slam_config.h"

namespace hv::replay {

/// The configuration file with what drives the robot in section `navigation`.
struct NavigationRunConfig {
  struct Navigation {
    navigation::MappingConfig mapping;
    navigation::PlanningConfig planning;

    void Describe(ConfigVisitor& visitor);
  };

  SlamConfig slam;
  Navigation navigation;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

}  // namespace hv::replay
