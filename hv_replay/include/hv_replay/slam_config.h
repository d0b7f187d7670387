#pragma once

#include "hv_core/config.h"
#include "hv_explore_sac/explorer_config.h"
#include "hv_lio/system_config.h"
#include "hv_loop_btc/loop_closer.h"
#include "hv_loop_btc/map_builder.h"
#include "hv_loop_btc/mapping_config.h"
#include "hv_navigation/navigation_config.h"
#include "hv_relocalize_ndt/localizer_config.h"

namespace hv::replay {

/// The whole configuration file: what the odometry node reads (`input`, `points`, `odometry`,
/// `output`), what the loop closing node reads (`loop`, `map`, `mapping`), what localisation reads
/// (`localization`), what navigation reads (`navigation`) and what exploration reads
/// (`exploration`).
struct SlamConfig {
  lio::SystemConfig system;
  loop::LoopConfig loop;
  loop::MapBuilderConfig map;
  loop::MappingNodeConfig mapping;  ///< of the node alone, kept so that one file serves all
  relocalize::LocalizerConfig localization;
  navigation::NavigationConfig navigation;
  explore::RobotExplorationConfig exploration;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

}  // namespace hv::replay
