#pragma once

#include "hv_explore_sac/exploration_config.h"

namespace hv::explore {

/// How large the cells and frontier points of a belief are for the learned policy. It knows lengths
/// as shares of the range from which frontier points are observed, and frontier points as lengths
/// of the border that they stand for, so that what was learned with the rules of the benchmark
/// holds for cells, blocks and views of any size.
struct PolicyScale {
  explicit PolicyScale(const ExplorationConfig& config);

  float unit;   ///< cells of the belief that are as long as one of the benchmark
  float point;  ///< frontier points of the benchmark that one of the belief stands for
};

}  // namespace hv::explore
