#include "hv_replay/navigation_config.h"

namespace hv::replay {

void NavigationRunConfig::Navigation::Describe(ConfigVisitor& visitor) {
  mapping.Describe(visitor);
  planning.Describe(visitor);
}

void NavigationRunConfig::Describe(ConfigVisitor& visitor) {
  slam.Describe(visitor);
  visitor.Section("navigation", navigation, "obstacles, plans and driving");
}

void NavigationRunConfig::Validate(ConfigProblems& problems) const {
  slam.Validate(problems);
  navigation.mapping.Validate(problems);
  navigation.planning.Validate(problems);
}

}  // namespace hv::replay
