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
  int rounds = 3;         ///< each improves on the policy of the one before
  int kept_rounds = 3;    ///< whose labels are learned from, the present one included
  double growth = 1.0;    ///< of maps and updates from round to round
  int networks = 1;       ///< that learn from the same labels; the policy imitates their mean
  int updates = 3000;     ///< of each in the first round
  int imitations = 3000;  ///< updates of the policy towards the mean in the first round
  int batch = 128;        ///< states an update, over all ranks

  /// What is `first` in the first round, in a later one; rounds count from 0.
  int Grown(int first, int round) const;

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
