#pragma once

#include <vector>

#include <Eigen/Core>

#include "hv_explore_sac/exploration_model.h"
#include "hv_explore_sac/observation.h"
#include "hv_explore_sac/policy/policy_config.h"
#include "hv_explore_sac/policy/policy_scale.h"

namespace hv::explore {

/// A viewpoint worth driving to, on behalf of those that observe much the same.
struct Goal {
  int node;                  ///< of the observation
  int fresh;                 ///< frontier points that it observes and no goal before it does
  float rank;                ///< log(utility) - decay x distance, in units of the benchmark
  Eigen::Vector2f frontier;  ///< mean of those points, relative to the robot [cells]
};

/// Chooses few goals that together observe most frontier points: by falling
/// utility x exp(-decay x distance), each with enough that those before it do not observe. Not
/// thread-safe.
class GoalSelector {
 public:
  explicit GoalSelector(const PolicyConfig& config) : config_(config) {}

  /// The best first. Not empty as long as any node has utility.
  const std::vector<Goal>& Select(const Observation& observation, const ExplorationModel& model);

 private:
  struct Ranked {
    float rank;
    int node;
  };
  void Rank(const Observation& observation, const PolicyScale& scale);
  bool TakeFresh(const Observation& observation, const ExplorationModel& model, Goal& goal);

  PolicyConfig config_;
  std::vector<Goal> goals_;
  std::vector<Ranked> ranked_;
  std::vector<int> seen_;
  std::vector<int> fresh_;
  std::vector<char> covered_;  ///< of each frontier point
};

}  // namespace hv::explore
