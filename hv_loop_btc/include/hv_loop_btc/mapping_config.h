#pragma once

#include <string>

#include "hv_core/config.h"
#include "hv_loop_btc/loop_closer.h"
#include "hv_loop_btc/map_builder.h"

namespace hv::loop {

/// What the loop closing node publishes. Section `mapping` of the configuration file.
struct MappingNodeConfig {
  std::string map_frame = "map";
  bool publish_tf = true;
  double tf_tolerance_s = 0.1;
  double correction_s = 1.0;
  bool autosave = true;
  double display_period_s = 2.0;
  double cloud_voxel_m = 0.2;
  int cloud_max_points = 1000000;
  double grid_period_s = 10.0;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// What the loop closing node reads of the configuration file: sections `loop`, `map`, `mapping`.
struct MappingConfig {
  LoopConfig loop;
  MapBuilderConfig map;
  MappingNodeConfig mapping;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

}  // namespace hv::loop
