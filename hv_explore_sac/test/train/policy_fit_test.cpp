#include "hv_explore_sac/train/policy_fit.h"

#include <gtest/gtest.h>

#include "hv_explore_sac/policy/policy_input.h"
#include "policy/random_states.h"
#include "policy/small_policy.h"

namespace hv::explore {
namespace {

/// States of random maps, with returns.
std::vector<LabelledState> SomeStates() {
  std::vector<LabelledState> labels;
  PolicyInput builder{PolicyConfig()};
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const RandomState state(seed, 3);
    if (!state.running()) continue;
    nn::GraphInput input;
    builder.Build(state.observation, state.environment.model(), std::nullopt, input);
    if (input.actions.size() < 2) continue;
    labels.push_back(
        {nn::PackedGraph(input),
         Eigen::VectorXf::LinSpaced(static_cast<Eigen::Index>(input.actions.size()), -1.0F, 1.0F)});
  }
  return labels;
}

/// How far the actor's preferences are from the mean of the policies', over all states.
double Divergence(const std::vector<std::shared_ptr<const PolicyNetwork>>& policies,
                  const std::vector<LabelledState>& labels, const nn::Sac& sac) {
  double sum = 0.0;
  for (const LabelledState& label : labels) {
    const nn::GraphInput input = label.state.Unpack();
    Eigen::VectorXf mean = Eigen::VectorXf::Zero(label.returns.size());
    for (const auto& policy : policies) mean += policy->Choose(input).log_probability;
    mean = (mean / static_cast<float>(policies.size())).array().exp().matrix().eval();
    mean /= mean.sum();
    const Eigen::VectorXf log_probability =
        sac.Policy(nn::BuildSample(input, sac.actor().config().pyramid_levels)).log_probability;
    sum += static_cast<double>(mean.dot((mean.array().log().matrix() - log_probability)));
  }
  return sum / static_cast<double>(labels.size());
}

nn::SacConfig SmallSac() {
  nn::SacConfig config;
  config.actor = config.critic = RandomNetwork()->settings().network;
  config.actor_optimiser.learning_rate = 0.01;
  config.actor_optimiser.warmup_steps = 10;
  return config;
}

TEST(PolicyFitTest, OnePolicyLearnsTheMeanPreferenceOfTwo) {
  const std::vector<LabelledState> labels = SomeStates();
  ASSERT_GT(labels.size(), 5U);
  const std::vector<std::shared_ptr<const PolicyNetwork>> two{RandomNetwork(1, 4.0F),
                                                              RandomNetwork(2, 4.0F)};
  nn::Sac sac(SmallSac(), PolicyNetwork::Shape(), PolicyInput::kGlobals);
  const double before = Divergence(two, labels, sac);
  ImitateMean(two, labels, 400, 16, 1, sac);
  EXPECT_LT(Divergence(two, labels, sac), 0.05 * before);
  // It is the mean that it has learned, not one of them.
  EXPECT_GT(Divergence({two[0]}, labels, sac), 2.0 * Divergence(two, labels, sac));
  EXPECT_GT(Divergence({two[1]}, labels, sac), 2.0 * Divergence(two, labels, sac));
}

TEST(PolicyFitTest, GivesTheSameForTheSameSeed) {
  const std::vector<LabelledState> labels = SomeStates();
  const std::vector<std::shared_ptr<const PolicyNetwork>> two{RandomNetwork(1, 4.0F),
                                                              RandomNetwork(2, 4.0F)};
  std::vector<Eigen::VectorXf> learned;
  for (int i = 0; i < 2; ++i) {
    nn::Sac sac(SmallSac(), PolicyNetwork::Shape(), PolicyInput::kGlobals);
    FitPolicy(labels, 5, 8, 1, 3, sac);
    ImitateMean(two, labels, 5, 8, 3, sac);
    learned.push_back(sac.actor_parameters());
  }
  EXPECT_EQ(learned[0], learned[1]);
}

}  // namespace
}  // namespace hv::explore
