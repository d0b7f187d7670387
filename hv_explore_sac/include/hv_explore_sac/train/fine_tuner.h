#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hv_explore_sac/nn/sac.h"
#include "hv_explore_sac/train/episode.h"
#include "hv_explore_sac/train/ranks.h"

namespace hv::explore {

/// Discrete SAC from a policy that already explores well (paper, Algorithm 1).
struct FineTuneConfig {
  int cycles = 0;            ///< of collecting and learning, 0 for none
  int episodes = 16;         ///< explored in a cycle, over all ranks
  int updates = 32;          ///< of policy and values in a cycle
  int batch = 64;            ///< transitions of an update, over all ranks
  int capacity = 40000;      ///< states in the replay buffer of a rank
  int first_episodes = 200;  ///< explored before the first cycle, over all ranks
  int value_updates = 1000;  ///< of the values alone before the first cycle
  int judge_every = 20;      ///< cycles after which the policy is tried

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Collects episodes into a replay buffer and learns from it. Depends on the seeds alone, whatever
/// the threads. Not thread-safe; uses TBB's threads.
class FineTuner {
 public:
  /// The maps, the sensor of `inputs` and `ranks` must outlive it.
  FineTuner(const FineTuneConfig& config, const EpisodeInputs& inputs,
            const nn::SacConfig& learning, std::vector<const ExplorationMap*> maps, Ranks& ranks);

  /// Takes over the policy, which also becomes the prior, and learns what its choices bring.
  void Begin(const Eigen::VectorXf& actor, std::uint64_t seed);
  /// Means over the updates of the cycle.
  nn::SacStatistics Cycle(std::uint64_t seed);

  const nn::Sac& sac() const { return sac_; }
  std::size_t states() const { return buffer_.states(); }

  /// Both files together hold everything. Reading throws InputError.
  void Save(const std::string& sac_path, const std::string& buffer_path) const;
  void Load(const std::string& sac_path, const std::string& buffer_path);

 private:
  std::vector<nn::Episode> Collect(int count, std::uint64_t seed) const;
  int ShareOfRank(int count) const;

  FineTuneConfig config_;
  EpisodeInputs inputs_;
  nn::SacConfig learning_;
  std::vector<const ExplorationMap*> maps_;
  Ranks& ranks_;
  nn::Sac sac_;
  nn::ReplayBuffer buffer_;
};

/// Makes a learner add up its gradients over the ranks.
void Reduce(Ranks& ranks, nn::Sac& sac);

}  // namespace hv::explore
