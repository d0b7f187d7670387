#include "hv_explore_sac/train/validation.h"

#include <tbb/parallel_for.h>

namespace hv::explore {

std::vector<const ExplorationMap*> ShareOf(const std::vector<const ExplorationMap*>& maps,
                                           const Ranks& ranks) {
  std::vector<const ExplorationMap*> share;
  const auto step = static_cast<std::size_t>(ranks.size());
  for (auto i = static_cast<std::size_t>(ranks.rank()); i < maps.size(); i += step) {
    share.push_back(maps[i]);
  }
  return share;
}

ValidationResult Validate(const std::vector<const ExplorationMap*>& maps,
                          const ExplorationConfig& config, const RaySensor& sensor,
                          const Rollout& rollout, Ranks& ranks) {
  const std::vector<const ExplorationMap*> share = ShareOf(maps, ranks);
  std::vector<float> travel(share.size());
  std::vector<float> done(share.size());
  tbb::parallel_for(std::size_t{0}, share.size(), [&](std::size_t i) {
    DungeonEnvironment environment(config, RewardConfig(), sensor, *share[i]);
    rollout.Finish(environment);
    travel[i] = static_cast<float>(environment.travel());
    done[i] = environment.complete() ? 1.0F : 0.0F;
  });
  float sums[2] = {0.0F, 0.0F};
  for (std::size_t i = 0; i < share.size(); ++i) {
    sums[0] += travel[i];
    sums[1] += done[i];
  }
  ranks.Sum(sums, 2);
  const auto count = static_cast<double>(maps.size());
  return {static_cast<double>(sums[0]) / count, static_cast<double>(sums[1]) / count};
}

}  // namespace hv::explore
