#pragma once

#include <string>

#include "hv_core/config.h"
#include "hv_explore_sac/reward.h"

namespace hv::explore {

/// Learning from the robot's own explorations (paper, Algorithm 1), beside them: the policy that
/// drives stays as it is, what is learned is kept apart.
struct OnlineLearningConfig {
  bool enabled = false;
  std::string folder;        ///< what is learned is kept there
  int cut_after = 32;        ///< decisions that are handed over together
  int updates = 2;           ///< for each decision
  int value_updates = 500;   ///< of the values alone, before the policy changes
  int batch = 32;            ///< decisions of an update
  int capacity = 20000;      ///< decisions remembered
  double discount = 0.98;    ///< gamma
  double temperature = 0.1;  ///< alpha at the start
  double learning_rate = 1e-4;
  double prior_weight = 1.0;  ///< of the divergence from the policy begun with
  RewardConfig reward;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

}  // namespace hv::explore
