#pragma once

#include <vector>

#include "hv_explore_sac/train/ranks.h"
#include "hv_explore_sac/train/rollout.h"

namespace hv::explore {

/// Means over runs.
struct ValidationResult {
  double travel = 0.0;  ///< [cells]
  double done = 0.0;    ///< share of the runs that ended as they should
};

/// Explores every map once, in parallel and shared out over the ranks.
ValidationResult Validate(const std::vector<const ExplorationMap*>& maps,
                          const ExplorationConfig& config, const RaySensor& sensor,
                          const Rollout& rollout, Ranks& ranks);

/// The maps that a rank works on: every `size`-th.
std::vector<const ExplorationMap*> ShareOf(const std::vector<const ExplorationMap*>& maps,
                                           const Ranks& ranks);

}  // namespace hv::explore
