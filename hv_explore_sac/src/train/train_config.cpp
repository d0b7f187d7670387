#include "hv_explore_sac/train/train_config.h"

namespace hv::explore {

void SplitConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("held_out", held_out, "last maps of the file, which training never sees");
  visitor.Field("validation", validation, "maps before them, which choose among policies");
}

void SplitConfig::Validate(ConfigProblems& problems) const {
  problems.Require(held_out >= 0, "split.held_out", "must not be negative");
  problems.Require(validation >= 1, "split.validation", "must be at least 1");
}

void ImprovementConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("rounds", rounds, "each improves on the policy of the one before");
  visitor.Field("kept_rounds", kept_rounds, "whose labels are learned from, this one included");
  visitor.Field("updates", updates, "of the policy in a round");
  visitor.Field("batch", batch, "states of an update, over all ranks");
}

void ImprovementConfig::Validate(ConfigProblems& problems) const {
  problems.Require(rounds >= 1, "improvement.rounds", "must be at least 1");
  problems.Require(kept_rounds >= 1, "improvement.kept_rounds", "must be at least 1");
  problems.Require(updates >= 1, "improvement.updates", "must be at least 1");
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
