#include "hv_explore_sac/reward.h"

#include <cmath>

namespace hv::explore {

void RewardConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("coverage", coverage, "reward for the explored share, from nothing to all");
  visitor.Field("frontier", frontier, "reward for each frontier_scale points observed");
  visitor.Field("distribution", distribution,
                "reward for each length_scale by which the centroid of frontiers moves");
  visitor.Field("path", path, "penalty for each length_scale driven");
  visitor.Field("completion", completion, "reward at the end");
  visitor.Field("frontier_scale", frontier_scale, "frontier points of one unit of reward");
  visitor.Field("length_scale", length_scale, "length of one unit of reward [cells]");
}

void RewardConfig::Validate(ConfigProblems& problems) const {
  const auto require = [&](double value, const char* key) {
    problems.Require(std::isfinite(value) && value >= 0.0, std::string("reward.") + key,
                     "must not be negative");
  };
  require(coverage, "coverage");
  require(frontier, "frontier");
  require(distribution, "distribution");
  require(path, "path");
  require(completion, "completion");
  problems.Require(frontier_scale > 0.0, "reward.frontier_scale", "must be positive");
  problems.Require(length_scale > 0.0, "reward.length_scale", "must be positive");
}

Reward RewardOf(const Transition& transition, const RewardConfig& config) {
  Reward reward;
  reward.coverage = config.coverage * (transition.explored_after - transition.explored_before);
  reward.frontier = config.frontier * transition.frontiers_observed / config.frontier_scale;
  if (transition.has_centroids) {
    const double moved = (transition.centroid_after - transition.centroid_before).norm();
    reward.distribution = config.distribution * moved / config.length_scale;
  }
  reward.path = -config.path * transition.path / config.length_scale;
  reward.completion = transition.complete ? config.completion : 0.0;
  return reward;
}

}  // namespace hv::explore
