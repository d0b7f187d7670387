#include "hv_explore_sac/nn/batch.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "hv_explore_sac/nn/sac.h"
#include "sample_graphs.h"

namespace hv::explore::nn {
namespace {

TEST(BatchSum, AddsEachSampleOnce) {
  BatchSum batch(100);
  for (const std::size_t count : {0U, 1U, 7U, 16U, 17U, 100U}) {
    const Eigen::VectorXf total =
        batch.Run(count, [](std::size_t sample, float* sum) { sum[sample] += 1.0F; });
    for (Index i = 0; i < total.size(); ++i) {
      EXPECT_EQ(total[i], i < static_cast<Index>(count) ? 1.0F : 0.0F);
    }
  }
}

SacConfig SmallSac() {
  SacConfig config;
  config.actor = config.critic = {16, 2, 16, 2, 1, 8};
  config.actor_optimiser.warmup_steps = config.critic_optimiser.warmup_steps = 0;
  config.prior_weight = 0.1;
  return config;
}

Transition RandomTransition(std::size_t seed) {
  Transition transition;
  const auto graph = static_cast<std::uint32_t>(seed);
  transition.state = BuildSample(RandomGraph(graph, 20 + static_cast<Index>(seed % 7), 3, 5), 1);
  transition.next = BuildSample(RandomGraph(graph + 100, 25, 3, 5), 1);
  transition.action = static_cast<int>(seed % transition.state.actions.size());
  transition.reward = 0.1F * static_cast<float>(seed % 5);
  transition.done = seed % 4 == 0;
  return transition;
}

/// All that learning changes, after a few updates by `threads` threads.
std::string Learned(std::size_t threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  Sac sac(SmallSac(), {3, 0, 1}, 2);
  sac.KeepPrior();
  for (int update = 0; update < 3; ++update) sac.Update(37, RandomTransition);
  Checkpoint checkpoint;
  sac.Save(checkpoint);
  return checkpoint.Serialize();
}

TEST(Batch, OneThreadEqualsMany) {
  const std::string expected = Learned(1);
  EXPECT_EQ(Learned(2), expected);
  EXPECT_EQ(Learned(8), expected);
}

/// Two halves that are added up, as ranks do, make the same step as the whole.
TEST(Batch, ReductionSeesGradientsAndCount) {
  Sac whole(SmallSac(), {3, 0, 1}, 2);
  Sac part(SmallSac(), {3, 0, 1}, 2);
  whole.Update(16, RandomTransition);
  Sac other(SmallSac(), {3, 0, 1}, 2);
  Eigen::VectorXf second_half;
  other.reduce = [&](Eigen::VectorXf& sums, double&) { second_half = sums; };
  other.Update(8, [](std::size_t i) { return RandomTransition(i + 8); });
  part.reduce = [&](Eigen::VectorXf& sums, double& samples) {
    sums += second_half;
    samples += 8.0;
  };
  part.Update(8, RandomTransition);
  EXPECT_LT((part.actor_parameters() - whole.actor_parameters()).cwiseAbs().maxCoeff(), 5e-5F);
  EXPECT_GT((other.actor_parameters() - whole.actor_parameters()).cwiseAbs().maxCoeff(), 1e-4F);
}

}  // namespace
}  // namespace hv::explore::nn
