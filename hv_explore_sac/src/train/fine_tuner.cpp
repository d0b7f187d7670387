#include "hv_explore_sac/train/fine_tuner.h"

#include <algorithm>
#include <random>
#include <utility>

#include <tbb/parallel_for.h>

#include "hv_core/file_io.h"
#include "hv_explore_sac/policy/policy_input.h"
#include "hv_explore_sac/policy/policy_network.h"

namespace hv::explore {

void FineTuneConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("cycles", cycles, "of collecting and learning by SAC, 0 for none");
  visitor.Field("episodes", episodes, "maps explored in a cycle, over all ranks");
  visitor.Field("updates", updates, "of policy and values in a cycle");
  visitor.Field("batch", batch, "transitions of an update, over all ranks");
  visitor.Field("capacity", capacity, "states in the replay buffer of a rank");
  visitor.Field("first_episodes", first_episodes, "maps explored before the first cycle");
  visitor.Field("value_updates", value_updates, "of the values alone before the first cycle");
  visitor.Field("judge_every", judge_every, "cycles after which the policy is tried");
}

void FineTuneConfig::Validate(ConfigProblems& problems) const {
  const auto at_least_one = [&problems](int value, const char* key) {
    problems.Require(value >= 1, std::string("fine_tune.") + key, "must be at least 1");
  };
  problems.Require(cycles >= 0, "fine_tune.cycles", "must not be negative");
  at_least_one(episodes, "episodes");
  at_least_one(updates, "updates");
  at_least_one(batch, "batch");
  at_least_one(capacity, "capacity");
  at_least_one(first_episodes, "first_episodes");
  at_least_one(judge_every, "judge_every");
  problems.Require(value_updates >= 0, "fine_tune.value_updates", "must not be negative");
}

FineTuner::FineTuner(const FineTuneConfig& config, const EpisodeInputs& inputs,
                     const nn::SacConfig& learning, std::vector<const ExplorationMap*> maps,
                     Ranks& ranks)
    : config_(config),
      inputs_(inputs),
      learning_(learning),
      maps_(std::move(maps)),
      ranks_(ranks),
      sac_(learning, PolicyNetwork::Shape(), PolicyInput::kGlobals),
      buffer_(static_cast<std::size_t>(config.capacity),
              std::max(learning.actor.pyramid_levels, learning.critic.pyramid_levels)) {
  Reduce(ranks, sac_);
}

void FineTuner::Begin(const Eigen::VectorXf& actor, std::uint64_t seed) {
  sac_.AdoptActor(actor);
  sac_.KeepPrior();
  nn::ReplayBuffer returns(static_cast<std::size_t>(config_.capacity),
                           learning_.critic.pyramid_levels);
  for (const nn::Episode& episode : Collect(config_.first_episodes, seed)) {
    buffer_.Add(episode);
    returns.Add(WithReturns(episode, learning_.discount));
  }
  std::mt19937_64 random(seed);
  const auto batch = static_cast<std::size_t>(ShareOfRank(config_.batch));
  for (int i = 0; i < config_.value_updates; ++i) {
    const std::vector<std::size_t> drawn = returns.Draw(batch, random);
    sac_.RegressValues(batch, [&](std::size_t sample) { return returns.Get(drawn[sample]); });
  }
}

nn::SacStatistics FineTuner::Cycle(std::uint64_t seed) {
  for (const nn::Episode& episode : Collect(config_.episodes, seed)) buffer_.Add(episode);
  std::mt19937_64 random(seed);
  const auto batch = static_cast<std::size_t>(ShareOfRank(config_.batch));
  nn::SacStatistics last;
  double critic_loss = 0.0;
  for (int i = 0; i < config_.updates; ++i) {
    const std::vector<std::size_t> drawn = buffer_.Draw(batch, random);
    last = sac_.Update(batch, [&](std::size_t sample) { return buffer_.Get(drawn[sample]); });
    critic_loss += last.critic_loss;
  }
  last.critic_loss = critic_loss / config_.updates;
  return last;
}

std::vector<nn::Episode> FineTuner::Collect(int count, std::uint64_t seed) const {
  std::vector<nn::Episode> episodes(static_cast<std::size_t>(ShareOfRank(count)));
  std::mt19937_64 random(seed);
  std::vector<std::size_t> chosen(episodes.size());
  for (std::size_t& map : chosen) map = random() % maps_.size();
  const Chooser choose = [this](const nn::GraphInput& input) {
    return sac_.Policy(nn::BuildSample(input, learning_.actor.pyramid_levels));
  };
  tbb::parallel_for(std::size_t{0}, episodes.size(), [&](std::size_t i) {
    episodes[i] = RunEpisode(*maps_[chosen[i]], inputs_, choose, seed + i + 1);
  });
  return episodes;
}

int FineTuner::ShareOfRank(int count) const { return std::max(1, count / ranks_.size()); }

void FineTuner::Save(const std::string& sac_path, const std::string& buffer_path) const {
  WriteFile(buffer_path, {buffer_.Serialize()});
  if (ranks_.rank() != 0) return;
  nn::Checkpoint checkpoint;
  sac_.Save(checkpoint);
  checkpoint.Write(sac_path);
}

void FineTuner::Load(const std::string& sac_path, const std::string& buffer_path) {
  sac_.Load(nn::Checkpoint::Read(sac_path));
  buffer_.Restore(ReadFile(buffer_path));
}

void Reduce(Ranks& ranks, nn::Sac& sac) {
  if (ranks.size() == 1) return;
  sac.reduce = [&ranks](Eigen::VectorXf& sums, double& samples) {
    ranks.Sum(sums.data(), static_cast<std::size_t>(sums.size()));
    samples *= ranks.size();
  };
}

}  // namespace hv::explore
