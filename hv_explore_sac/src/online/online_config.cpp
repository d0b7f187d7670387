#include "hv_explore_sac/online/online_config.h"

namespace hv::explore {

void OnlineLearningConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("enabled", enabled, "learn from the robot's own explorations, with planner sac");
  visitor.Field("folder", folder, "for what is learned, path; weights there are used by nobody");
  visitor.Field("cut_after", cut_after, "decisions that are handed to the learner together");
  visitor.Field("updates", updates, "of policy and values for each decision");
  visitor.Field("value_updates", value_updates,
                "of the values alone at first, before the policy changes");
  visitor.Field("batch", batch, "decisions of an update");
  visitor.Field("capacity", capacity, "decisions that are remembered");
  visitor.Field("discount", discount, "gamma, weight of the next decision's value");
  visitor.Field("temperature", temperature, "alpha, weight of the entropy at the start");
  visitor.Field("learning_rate", learning_rate, "of policy and values");
  visitor.Field("prior_weight", prior_weight,
                "of the divergence from the policy that was begun with");
  visitor.Section("reward", reward, "of a decision");
}

void OnlineLearningConfig::Validate(ConfigProblems& problems) const {
  const auto require = [&](bool condition, const char* key, const char* text) {
    problems.Require(condition, std::string("online_learning.") + key, text);
  };
  require(!enabled || !folder.empty(), "folder", "must be set to learn");
  require(cut_after >= 2, "cut_after", "must be at least 2");
  require(updates >= 1, "updates", "must be at least 1");
  require(value_updates >= 0, "value_updates", "must not be negative");
  require(batch >= 1, "batch", "must be at least 1");
  require(capacity > cut_after, "capacity", "must be above cut_after");
  require(discount >= 0.0 && discount < 1.0, "discount", "must be within 0 and 1");
  require(temperature > 0.0 && temperature <= 1.0, "temperature", "must be above 0 and at most 1");
  require(learning_rate > 0.0, "learning_rate", "must be positive");
  require(prior_weight >= 0.0, "prior_weight", "must not be negative");
  reward.Validate(problems);
}

}  // namespace hv::explore
