#include "hv_loop_btc/mapping_config.h"

namespace hv::loop {

void MappingNodeConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("map_frame", map_frame, "fixed frame of the map");
  visitor.Field("publish_tf", publish_tf, "publish map -> odom on /tf");
  visitor.Field("tf_tolerance_s", tf_tolerance_s,
                "how far map -> odom is stamped into the future, so that nobody waits for it [s]");
  visitor.Field("correction_s", correction_s,
                "time in which map -> odom moves to a new value; 0 = at once [s]");
  visitor.Field("autosave", autosave, "save the map at exit, to the node's parameter map_path");
  visitor.Field("display_period_s", display_period_s,
                "shortest period of path, markers and cloud [s]");
  visitor.Field("cloud_voxel_m", cloud_voxel_m, "grid of the published cloud [m]");
  visitor.Field("cloud_max_points", cloud_max_points,
                "most points of the published cloud; its grid becomes coarser beyond");
  visitor.Field("grid_period_s", grid_period_s, "shortest period of the published 2-D grid [s]");
}

void MappingNodeConfig::Validate(ConfigProblems& problems) const {
  problems.Require(!map_frame.empty(), "mapping.map_frame", "must not be empty");
  problems.Require(tf_tolerance_s >= 0.0 && tf_tolerance_s <= 1.0, "mapping.tf_tolerance_s",
                   "must be between 0 and 1");
  problems.Require(correction_s >= 0.0, "mapping.correction_s", "must not be negative");
  problems.Require(display_period_s > 0.0, "mapping.display_period_s", "must be positive");
  problems.Require(cloud_voxel_m >= 0.02, "mapping.cloud_voxel_m", "must be at least 0.02");
  problems.Require(cloud_max_points >= 1000, "mapping.cloud_max_points", "must be at least 1000");
  problems.Require(grid_period_s > 0.0, "mapping.grid_period_s", "must be positive");
}

void MappingConfig::Describe(ConfigVisitor& visitor) {
  visitor.Section("loop", loop, "loop closing");
  visitor.Section("map", map, "what is made of the keyframes when a map is saved");
  visitor.Section("mapping", mapping, "what the loop closing node publishes");
  for (const char* section :
       {"input", "points", "odometry", "output", "localization", "navigation", "exploration"}) {
    visitor.Foreign(section);
  }
}

void MappingConfig::Validate(ConfigProblems& problems) const {
  loop.Validate(problems);
  map.Validate(problems);
  mapping.Validate(problems);
}

}  // namespace hv::loop
