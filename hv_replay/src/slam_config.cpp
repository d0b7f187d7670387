#include "hv_replay/slam_config.h"

namespace hv::replay {

void SlamConfig::Describe(ConfigVisitor& visitor) {
  system.Describe(visitor);
  visitor.Section("loop", loop, "loop closing");
  visitor.Section("map", map, "what is made of the keyframes when a map is saved");
  visitor.Section("mapping", mapping, "what the loop closing node publishes");
  visitor.Section("localization", localization, "localisation in a saved map");
  visitor.Section("navigation", navigation, "obstacles and ways");
  visitor.Section("exploration", exploration, "exploration of unknown places");
}

void SlamConfig::Validate(ConfigProblems& problems) const {
  system.Validate(problems);
  loop.Validate(problems);
  map.Validate(problems);
  mapping.Validate(problems);
  localization.Validate(problems);
  navigation.Validate(problems);
  exploration.Validate(problems);
}

}  // namespace hv::replay
