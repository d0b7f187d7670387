#include "hv_relocalize_ndt/localizer_config.h"

namespace hv::relocalize {

void TrackingConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("period_s", period_s, "between comparisons of a scan with the map [s]");
  visitor.Field("search_period_s", search_period_s, "between searches while lost [s]");
  visitor.Field(
      "drift_translation", drift_translation,
      "error of odometry's position, share of the distance from one correction to the next");
  visitor.Field("drift_rotation_deg", drift_rotation_deg, "error of its heading [deg/m]");
  visitor.Field("drift_tilt_deg", drift_tilt_deg, "error of its vertical [deg/m]");
  visitor.Field("waiting_m", waiting_m, "error of its position in a second [m]");
  visitor.Field("tilt_sigma_deg", tilt_sigma_deg,
                "standard deviation between the verticals of map and odometry [deg]");
  visitor.Field("min_sigma_m", min_sigma_m,
                "standard deviation of the best comparison, of the position [m]");
  visitor.Field("min_sigma_deg", min_sigma_deg, "and of the rotation [deg]");
  visitor.Field("min_overlap", min_overlap,
                "share of the scan that must lie where the map knows anything, 0 to 1");
  visitor.Field("min_agreement", min_agreement,
                "share of that part of the scan that must fit, 0 to 1");
  visitor.Field("max_seen_through", max_seen_through,
                "share of the map in view that the scan may pass through, 0 to 1");
  visitor.Field("gate_sigmas", gate_sigmas,
                "standard deviations by which a comparison may differ from what is expected");
  visitor.Field("misses", misses, "contradictions in a row after which the place is lost");
  visitor.Field("max_sigma_m", max_sigma_m,
                "standard deviation of the position at which it is lost outside of the map [m]");
  visitor.Field("silence_s", silence_s, "time without scans after which the place is lost [s]");
}

void TrackingConfig::Validate(ConfigProblems& problems) const {
  const auto positive = [&](double value, const char* key) {
    problems.Require(value > 0.0, std::string("tracking.") + key, "must be positive");
  };
  const auto share = [&](double value, const char* key) {
    problems.Require(value >= 0.0 && value <= 1.0, std::string("tracking.") + key,
                     "must lie between 0 and 1");
  };
  positive(period_s, "period_s");
  positive(search_period_s, "search_period_s");
  positive(drift_translation, "drift_translation");
  positive(drift_rotation_deg, "drift_rotation_deg");
  positive(drift_tilt_deg, "drift_tilt_deg");
  positive(waiting_m, "waiting_m");
  positive(tilt_sigma_deg, "tilt_sigma_deg");
  positive(min_sigma_m, "min_sigma_m");
  positive(min_sigma_deg, "min_sigma_deg");
  positive(gate_sigmas, "gate_sigmas");
  positive(max_sigma_m, "max_sigma_m");
  positive(silence_s, "silence_s");
  share(min_overlap, "min_overlap");
  share(min_agreement, "min_agreement");
  share(max_seen_through, "max_seen_through");
  problems.Require(misses >= 1, "tracking.misses", "must be at least 1");
}

void LocalizationOutputConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("map_frame", map_frame, "fixed frame of the map");
  visitor.Field("publish_tf", publish_tf, "publish map -> odom on /tf");
  visitor.Field("tf_tolerance_s", tf_tolerance_s,
                "how far map -> odom is stamped into the future, so that nobody waits for it [s]");
  visitor.Field("correction_s", correction_s,
                "time in which map -> odom moves to a new value; 0 = at once [s]");
  visitor.Field("cloud_voxel_m", cloud_voxel_m, "grid of the published map cloud [m]");
  visitor.Field("cloud_max_points", cloud_max_points,
                "most points of the published map cloud; its grid becomes coarser beyond");
  visitor.Field("path_min_distance_m", path_min_distance_m,
                "distance between two poses of the published path [m]");
  visitor.Field("path_max_poses", path_max_poses,
                "most poses of the published path; it becomes coarser beyond");
}

void LocalizationOutputConfig::Validate(ConfigProblems& problems) const {
  const auto require = [&](bool condition, const char* key, const char* what) {
    problems.Require(condition, std::string("output.") + key, what);
  };
  require(!map_frame.empty(), "map_frame", "must not be empty");
  require(tf_tolerance_s >= 0.0 && tf_tolerance_s <= 1.0, "tf_tolerance_s",
          "must be between 0 and 1");
  require(correction_s >= 0.0, "correction_s", "must not be negative");
  require(cloud_voxel_m >= 0.02, "cloud_voxel_m", "must be at least 0.02");
  require(cloud_max_points >= 1000, "cloud_max_points", "must be at least 1000");
  require(path_min_distance_m >= 0.0, "path_min_distance_m", "must not be negative");
  require(path_max_poses >= 2, "path_max_poses", "must be at least 2");
}

void LocalizerConfig::Describe(ConfigVisitor& visitor) {
  relocalize.Describe(visitor);
  visitor.Section("tracking", tracking, "the pose in the map while the robot moves");
  visitor.Section("submap", submap, "scans that are looked for together while the place is lost");
  visitor.Section("output", output, "what the localisation node publishes");
}

void LocalizerConfig::Validate(ConfigProblems& problems) const {
  relocalize.Validate(problems);
  tracking.Validate(problems);
  submap.Validate(problems);
  output.Validate(problems);
}

void LocalizationNodeConfig::Describe(ConfigVisitor& visitor) {
  visitor.Section("localization", localization, "localisation in a saved map");
  for (const char* section : {"input", "points", "odometry", "output", "loop", "map", "mapping",
                              "navigation", "exploration"}) {
    visitor.Foreign(section);
  }
}

void LocalizationNodeConfig::Validate(ConfigProblems& problems) const {
  localization.Validate(problems);
}

}  // namespace hv::relocalize
