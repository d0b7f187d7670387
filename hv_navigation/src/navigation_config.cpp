#include "hv_navigation/navigation_config.h"

namespace hv::navigation {

void NavigationNodeOptions::Describe(ConfigVisitor& visitor) {
  visitor.Field("map_frame", map_frame, "fixed frame of the map");
  visitor.Field("place_timeout_s", place_timeout_s,
                "age of map -> odom at which the place in the map counts as lost [s]");
  visitor.Field("place_jump_m", place_jump_m,
                "correction of the place after which what was seen in the map is forgotten [m]");
  visitor.Field("place_jump_deg", place_jump_deg, "the same for the heading [deg]");
  visitor.Field("map_period_s", map_period_s, "shortest period of the published map [s]");
}

void NavigationNodeOptions::Validate(ConfigProblems& problems) const {
  const auto positive = [&](double value, const char* key) {
    problems.Require(value > 0.0, std::string("node.") + key, "must be positive");
  };
  problems.Require(!map_frame.empty(), "node.map_frame", "must not be empty");
  positive(place_timeout_s, "place_timeout_s");
  positive(place_jump_m, "place_jump_m");
  positive(place_jump_deg, "place_jump_deg");
  positive(map_period_s, "map_period_s");
}

void NavigationConfig::Describe(ConfigVisitor& visitor) {
  visitor.Section("mapping", mapping, "what stands around the robot");
  visitor.Section("planning", planning, "ways to the goal");
  visitor.Section("node", node, "how the navigation node is tied in");
}

void NavigationConfig::Validate(ConfigProblems& problems) const {
  mapping.Validate(problems);
  planning.Validate(problems);
  node.Validate(problems);
}

void NavigationNodeConfig::Describe(ConfigVisitor& visitor) {
  visitor.Section("navigation", navigation, "obstacles and ways");
  for (const char* section : {"input", "points", "odometry", "output", "loop", "map", "mapping",
                              "localization", "exploration"}) {
    visitor.Foreign(section);
  }
}

void NavigationNodeConfig::Validate(ConfigProblems& problems) const {
  navigation.Validate(problems);
}

}  // namespace hv::navigation
