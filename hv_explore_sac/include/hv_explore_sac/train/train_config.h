#pragma once

#include "hv_explore_sac/exploration_config.h"
#include "hv_explore_sac/loop_guard.h"
#include "hv_explore_sac/nn/sac_config.h"
#include "hv_explore_sac/planner.h"
#include "hv_explore_sac/policy/policy_config.h"
#include "hv_explore_sac/reward.h"
#include "hv_explore_sac/train/fine_tuner.h"
#include "hv_explore_sac/train/labels.h"

namespace hv::explore {

/// Which maps serve what: of the file, the last `held_out` are never looked at, those before them
/// choose among policies, the others teach.
struct SplitConfig {
  int held_out = 400;
  int validation = 200;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Policy improvement by rollouts.
struct ImprovementConfig {
  int rounds = 3;       ///< each improves on the policy of the one before
  int kept_rounds = 3;  ///< whose labels are learned from, the present one included
  int updates = 3000;   ///< of the policy in a round
  int batch = 128;      ///< states an update, over all ranks

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// All that a training depends on but the maps.
struct TrainConfig {
  ExplorationConfig exploration;
  PlannerConfig planner;
  GuardConfig guard;
  PolicyConfig policy;
  SplitConfig split;
  LabelConfig labels;
  ImprovementConfig improvement;
  FineTuneConfig fine_tune;
  RewardConfig reward;
  nn::SacConfig sac;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

}  // namespace hv::explore
