#pragma once

#include <string>

#include "hv_core/config.h"
#include "hv_relocalize_ndt/recent_scans.h"
#include "hv_relocalize_ndt/relocalize_config.h"

namespace hv::relocalize {

/// How the pose in the map is tracked.
struct TrackingConfig {
  double period_s = 0.5;
  double search_period_s = 1.0;
  double drift_translation = 0.02;
  double drift_rotation_deg = 0.06;
  double drift_tilt_deg = 0.01;
  double waiting_m = 0.01;
  double tilt_sigma_deg = 0.3;
  double min_sigma_m = 0.01;
  double min_sigma_deg = 0.05;
  double min_overlap = 0.5;
  double min_agreement = 0.55;
  double max_seen_through = 0.1;
  double gate_sigmas = 5.0;
  int misses = 3;
  double max_sigma_m = 1.5;
  double silence_s = 1.0;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// What the localisation node publishes; the offline tools do not use it.
struct LocalizationOutputConfig {
  std::string map_frame = "map";
  bool publish_tf = true;
  double tf_tolerance_s = 0.1;
  double correction_s = 0.5;
  double cloud_voxel_m = 0.2;
  int cloud_max_points = 1000000;
  double path_min_distance_m = 0.1;
  int path_max_poses = 20000;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Everything that localisation can be told. Section `localization` of the configuration file.
struct LocalizerConfig {
  RelocalizeConfig relocalize;
  TrackingConfig tracking;
  RecentScansConfig submap;
  LocalizationOutputConfig output;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// What the localisation node reads of the configuration file.
struct LocalizationNodeConfig {
  LocalizerConfig localization;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

}  // namespace hv::relocalize
