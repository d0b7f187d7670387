#pragma once

#include <cstdint>
#include <functional>

#include "hv_explore_sac/exploration_config.h"
#include "hv_explore_sac/exploration_map.h"
#include "hv_explore_sac/nn/policy.h"
#include "hv_explore_sac/nn/replay_buffer.h"
#include "hv_explore_sac/policy/policy_config.h"
#include "hv_explore_sac/ray_sensor.h"
#include "hv_explore_sac/reward.h"

namespace hv::explore {

/// Everything of an environment that episodes are made with.
struct EpisodeInputs {
  ExplorationConfig exploration;
  PolicyConfig policy;
  RewardConfig reward;
  const RaySensor* sensor = nullptr;
};

/// Called from several threads.
using Chooser = std::function<nn::ActionDistribution(const nn::GraphInput& input)>;

/// One run on a map (paper, Algorithm 1): at each viewpoint a goal is drawn from what `choose`
/// prefers, and one edge is driven towards it. Depends on the seed alone.
nn::Episode RunEpisode(const ExplorationMap& map, const EpisodeInputs& inputs,
                       const Chooser& choose, std::uint64_t seed);

/// The same with rewards replaced by what is gained from there to the end, discounted.
nn::Episode WithReturns(nn::Episode episode, double discount);

}  // namespace hv::explore
