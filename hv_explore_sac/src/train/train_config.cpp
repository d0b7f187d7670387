#include "hv_explore_sac/train/train_config.h"

#include <cmath>

namespace hv::explore {

void SplitConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("held_out", held_out, "last maps of the file, which training never sees");
  visitor.Field("validation", validation, "maps before them, which choose among policies");
}

void SplitConfig::Validate(ConfigProblems& problems) const {
  problems.Require(held_out >= 0, "split.held_out", "must not be negative");
  problems.Require(validation >= 1, "split.validation", "must be at least 1");
}

int ImprovementConfig::Grown(int first, int round) const {
  return static_cast<int>(std::lround(first * std::pow(growth, round)));
}

void ImprovementConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("rounds", rounds, "each improves on the policy of the one before");
  visitor.Field("kept_rounds", kept_rounds, "whose labels are learned from, this one included");
  visitor.Field("growth", growth,
                "of maps, updates and imitations from round to round: at first a bad policy is not "
                "worth many measurements");
  visitor.Field("networks", networks,
                "that learn from the same labels; if several, the policy imitates their mean");
  visitor.Field("updates", updates, "of each of them in the first round");
  visitor.Field("imitations", imitations,
                "updates of the policy towards the mean of several networks in the first round");
  visitor.Field("batch", batch, "states of an update, over all ranks");
}

void ImprovementConfig::Validate(ConfigProblems& problems) const {
  problems.Require(rounds >= 1, "improvement.rounds", "must be at least 1");
  problems.Require(kept_rounds >= 1, "improvement.kept_rounds", "must be at least 1");
  problems.Require(growth >= 1.0, "improvement.growth", "must be at least 1");
  problems.Require(networks >= 1, "improvement.networks", "must be at least 1");
  problems.Require(updates >= 1, "improvement.updates", "must be at least 1");
  problems.Require(imitations >= 1, "improvement.imitations", "must be at least 1");
  problems.Require(batch >= 1, "improvement.batch", "must be at least 1");
}

void TrainConfig::Describe(ConfigVisitor& visitor) {
  visitor.Section("exploration", exploration, "the belief, the graph and the simulation");
  visitor.Section("planner", planner, "planners that need no learning");
  visitor.Section("guard", guard, "against loops and goals that fail");
  visitor.Section("policy", policy, "what the learned policy chooses among");
  visitor.Section("split", split, "which maps serve what");
  visitor.Section("labels", labels, "where choices are measured");
  visitor.Section("improvement", improvement, "rounds of measuring and learning");
  visitor.Section("fine_tune", fine_tune, "SAC after the rounds");
  visitor.Section("reward", reward, "of SAC");
  visitor.Section("sac", sac, "networks and how they learn");
}

void TrainConfig::Validate(ConfigProblems& problems) const {
  exploration.Validate(problems);
  planner.Validate(problems);
  guard.Validate(problems);
  policy.Validate(problems);
  split.Validate(problems);
  labels.Validate(problems);
  improvement.Validate(problems);
  fine_tune.Validate(problems);
  reward.Validate(problems);
  sac.Validate(problems);
}

}  // namespace hv::explore
