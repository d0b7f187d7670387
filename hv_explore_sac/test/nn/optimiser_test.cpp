#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "hv_explore_sac/nn/adam.h"
#include "hv_explore_sac/nn/policy.h"

namespace hv::explore::nn {
namespace {

/// Two steps by hand, as Kingma and Ba write them.
TEST(Adam, StepsAsPublished) {
  AdamConfig config;
  config.learning_rate = 0.1;
  config.clip_norm = 0.0;
  config.warmup_steps = 0;
  Adam adam(config, 1);
  Eigen::VectorXf x = Eigen::VectorXf::Constant(1, 1.0F);
  double expected = 1.0;
  double mean = 0.0;
  double square = 0.0;
  for (const double g : {2.0, -1.0}) {
    Eigen::VectorXf gradient = Eigen::VectorXf::Constant(1, static_cast<float>(g));
    adam.Step(gradient, x);
    const double step = static_cast<double>(adam.state().steps);
    mean = 0.9 * mean + 0.1 * g;
    square = 0.999 * square + 0.001 * g * g;
    expected -= 0.1 * mean / (1.0 - std::pow(0.9, step)) /
                (std::sqrt(square / (1.0 - std::pow(0.999, step))) + 1e-8);
    EXPECT_NEAR(static_cast<double>(x[0]), expected, 1e-5);
  }
}

TEST(Adam, FindsTheBottomOfABowl) {
  AdamConfig config;
  config.learning_rate = 0.05;
  config.decay_steps = 900;
  Adam adam(config, 3);
  const Eigen::Vector3f bottom(1.0F, -2.0F, 0.5F);
  Eigen::VectorXf x = Eigen::VectorXf::Zero(3);
  for (int i = 0; i < 1000; ++i) {
    Eigen::VectorXf gradient = x - bottom;
    adam.Step(gradient, x);
  }
  EXPECT_LT((x - bottom).norm(), 1e-3F);
}

TEST(Adam, ClipsAndRefuses) {
  AdamConfig config;
  config.clip_norm = 1.0;
  Adam adam(config, 2);
  Eigen::VectorXf x = Eigen::VectorXf::Zero(2);
  Eigen::VectorXf gradient = Eigen::Vector2f(3.0F, 4.0F);
  EXPECT_NEAR(adam.Step(gradient, x), 5.0, 1e-6);
  EXPECT_NEAR(static_cast<double>(gradient.norm()), 1.0, 1e-6);
  const Eigen::VectorXf before = x;
  gradient[0] = std::numeric_limits<float>::quiet_NaN();
  adam.Step(gradient, x);
  EXPECT_EQ(x, before);
  EXPECT_EQ(adam.refused(), 1);
  EXPECT_EQ(adam.state().steps, 1);
}

TEST(Adam, LearningRateRisesAndFalls) {
  AdamConfig config;
  config.learning_rate = 1.0;
  config.warmup_steps = 10;
  config.decay_steps = 100;
  EXPECT_DOUBLE_EQ(config.LearningRate(0), 0.1);
  EXPECT_DOUBLE_EQ(config.LearningRate(9), 1.0);
  EXPECT_DOUBLE_EQ(config.LearningRate(10), 1.0);
  EXPECT_NEAR(config.LearningRate(60), 0.55, 1e-12);
  EXPECT_NEAR(config.LearningRate(110), 0.1, 1e-12);
  EXPECT_NEAR(config.LearningRate(100000), 0.1, 1e-12);
}

TEST(Policy, IsADistributionForAnyScores) {
  for (const float scale : {0.0F, 1.0F, 1e4F}) {
    Eigen::VectorXf scores(3);
    scores << scale, -scale, 0.5F * scale;
    const ActionDistribution policy = ToDistribution({scores.data(), 3, 1});
    EXPECT_NEAR(static_cast<double>(policy.probability.sum()), 1.0, 1e-6);
    EXPECT_TRUE(policy.log_probability.allFinite());
    EXPECT_TRUE(std::isfinite(policy.Entropy()));
    EXPECT_EQ(policy.Best(), 0);
  }
}

TEST(Policy, DrawsByProbability) {
  Eigen::VectorXf scores(3);
  scores << std::log(0.2F), std::log(0.5F), std::log(0.3F);
  const ActionDistribution policy = ToDistribution({scores.data(), 3, 1});
  EXPECT_EQ(policy.Draw(0.0), 0);
  EXPECT_EQ(policy.Draw(0.19), 0);
  EXPECT_EQ(policy.Draw(0.21), 1);
  EXPECT_EQ(policy.Draw(0.69), 1);
  EXPECT_EQ(policy.Draw(0.71), 2);
  EXPECT_EQ(policy.Draw(1.0), 2);
}

/// d/dz of sum p (alpha log p - q), numerically: the derivative of the logarithm cancels.
TEST(Policy, ExpectationGradientHoldsForEntropyToo) {
  Eigen::VectorXf scores(4);
  scores << 0.3F, -0.7F, 1.1F, 0.0F;
  Eigen::VectorXf q(4);
  q << 1.0F, 2.0F, -1.0F, 0.5F;
  const auto cost = [&](const Eigen::VectorXf& z) -> Eigen::VectorXf {
    return 0.4F * ToDistribution({z.data(), 4, 1}).log_probability - q;
  };
  const auto loss = [&](const Eigen::VectorXf& z) {
    return ToDistribution({z.data(), 4, 1}).probability.dot(cost(z));
  };
  const ActionDistribution policy = ToDistribution({scores.data(), 4, 1});
  const Eigen::VectorXf gradient = ExpectationGradient(policy, cost(scores));
  for (Index i = 0; i < 4; ++i) {
    const Eigen::VectorXf step = 1e-2F * Eigen::VectorXf::Unit(4, i);
    EXPECT_NEAR(gradient[i], (loss(scores + step) - loss(scores - step)) / 2e-2F, 1e-4F);
  }
}

}  // namespace
}  // namespace hv::explore::nn
