#include "hv_explore_sac/train/episode.h"

#include <optional>
#include <random>
#include <utility>

#include "hv_explore_sac/dungeon_environment.h"
#include "hv_explore_sac/policy/policy_input.h"
#include "uniform.h"

namespace hv::explore {

nn::Episode RunEpisode(const ExplorationMap& map, const EpisodeInputs& inputs,
                       const Chooser& choose, std::uint64_t seed) {
  DungeonEnvironment environment(inputs.exploration, inputs.reward, *inputs.sensor, map);
  PolicyInput builder(inputs.policy);
  std::mt19937_64 random(seed);
  Observation observation;
  nn::GraphInput input;
  std::optional<Eigen::Vector2i> kept;
  nn::Episode episode;
  while (environment.ending() == Ending::kRunning) {
    environment.Observe(observation);
    builder.Build(observation, environment.model(), kept, input);
    const auto action = static_cast<int>(choose(input).Draw(Uniform(random)));
    const int goal = builder.goals()[static_cast<std::size_t>(action)].node;
    kept = environment.model().graph().CellOf(observation.node(goal).viewpoint);
    const int hop = observation.FirstHopTo(goal);
    const Reward reward = environment.Step(observation.node(hop).viewpoint);
    episode.steps.push_back({input, action, static_cast<float>(reward.Total()), {}});
  }
  episode.done = environment.complete();
  if (episode.done) return episode;
  environment.Observe(observation);
  builder.Build(observation, environment.model(), kept, episode.last);
  return episode;
}

nn::Episode WithReturns(nn::Episode episode, double discount) {
  double sum = 0.0;
  for (auto step = episode.steps.rbegin(); step != episode.steps.rend(); ++step) {
    sum = static_cast<double>(step->reward) + discount * sum;
    step->reward = static_cast<float>(sum);
  }
  return episode;
}

}  // namespace hv::explore
