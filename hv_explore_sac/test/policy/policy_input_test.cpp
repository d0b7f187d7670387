#include "hv_explore_sac/policy/policy_input.h"

#include <gtest/gtest.h>

#include "hv_explore_sac/loop_guard.h"
#include "hv_explore_sac/policy/policy_planner.h"
#include "random_states.h"
#include "small_policy.h"

namespace hv::explore {
namespace {

nn::GraphInput InputOf(const RandomState& state, bool ways = false) {
  PolicyConfig config;
  config.ways = ways;
  PolicyInput builder(config);
  nn::GraphInput input;
  builder.Build(state.observation, state.environment.model(), std::nullopt, input);
  return input;
}

class PolicyInputs : public testing::TestWithParam<unsigned> {};

TEST_P(PolicyInputs, AreFiniteAndOfSizeOne) {
  const RandomState state(GetParam());
  if (!state.running()) GTEST_SKIP();
  const nn::GraphInput input = InputOf(state, true);
  EXPECT_TRUE(input.features.allFinite());
  EXPECT_LT(input.features.cwiseAbs().maxCoeff(), 10.0F);
  EXPECT_TRUE(input.globals.allFinite());
  EXPECT_NO_THROW(nn::BuildSample(input, 2));
}

TEST_P(PolicyInputs, WaysAddNodesAndChangeNoOther) {
  const RandomState state(GetParam());
  if (!state.running()) GTEST_SKIP();
  const nn::GraphInput core = InputOf(state);
  const nn::GraphInput all = InputOf(state, true);
  ASSERT_GE(all.features.rows(), core.features.rows());
  EXPECT_EQ(all.features.topRows(core.features.rows()), core.features);
  EXPECT_EQ(all.actions, core.actions);
}

TEST_P(PolicyInputs, SymmetriesKeepAllButDirections) {
  const RandomState state(GetParam());
  if (!state.running()) GTEST_SKIP();
  const nn::GraphInput input = InputOf(state);
  const Eigen::Index scalars = PolicyInput::kFeatures - 2 * PolicyInput::kVectors;
  for (int symmetry = 0; symmetry < kSymmetries; ++symmetry) {
    nn::GraphInput turned = input;
    Transform(symmetry, turned);
    EXPECT_EQ(turned.features.rightCols(scalars), input.features.rightCols(scalars));
    EXPECT_TRUE(turned.positions.rowwise().norm().isApprox(input.positions.rowwise().norm()));
    const Eigen::VectorXf dot =
        (input.features.leftCols(2).array() * input.features.middleCols(2, 2).array())
            .rowwise()
            .sum();
    const Eigen::VectorXf turned_dot =
        (turned.features.leftCols(2).array() * turned.features.middleCols(2, 2).array())
            .rowwise()
            .sum();
    EXPECT_TRUE(turned_dot.isApprox(dot, 1e-5F) || dot.norm() < 1e-5F);
  }
}

INSTANTIATE_TEST_SUITE_P(RandomStates, PolicyInputs, testing::Range(1U, 7U));

TEST(UnknownShareTest, CountsWhatIsUnknown) {
  Belief belief(64, 48);
  Frontiers frontiers(FrontierConfig(), belief);
  UnknownShare share;
  share.Count(frontiers, 2);
  EXPECT_FLOAT_EQ(share.Everywhere(), 1.0F);
  EXPECT_FLOAT_EQ(share.Around({32.0F, 24.0F}, 16.0F), 1.0F);
  EXPECT_FLOAT_EQ(share.Around({0.0F, 24.0F}, 16.0F), 0.5F);
  EXPECT_FLOAT_EQ(share.Around({-100.0F, 24.0F}, 16.0F), 0.0F);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 32; ++x) belief.Set(belief.IndexOf({x, y}), Cell::kFree);
  }
  frontiers.Update(belief);
  share.Count(frontiers, 2);
  EXPECT_FLOAT_EQ(share.Everywhere(), 0.5F);
  EXPECT_FLOAT_EQ(share.Around({16.0F, 24.0F}, 8.0F), 0.0F);
  EXPECT_FLOAT_EQ(share.Around({32.0F, 24.0F}, 16.0F), 0.5F);
}

TEST(PolicyPlannerTest, ExploresWithAnyWeights) {
  const auto network = RandomNetwork();
  RandomState state(2, 0);
  PolicyPlanner planner(network);
  LoopGuard guard{GuardConfig()};
  while (state.running()) {
    const Decision decision =
        guard.Review(planner.Choose(state.observation, state.environment.model()),
                     state.observation, state.environment.model());
    state.environment.Step(state.observation.node(decision.action).viewpoint);
    state.environment.Observe(state.observation);
  }
  EXPECT_TRUE(state.environment.complete());
}

TEST(PolicyNetworkTest, AFileGivesTheSamePolicy) {
  const auto network = RandomNetwork();
  const std::string path = testing::TempDir() + "policy.bin";
  network->ToCheckpoint().Write(path);
  const auto read = PolicyNetwork::Read(path);
  const nn::GraphInput input = InputOf(RandomState(1));
  EXPECT_EQ(read->Choose(input).probability, network->Choose(input).probability);
}

}  // namespace
}  // namespace hv::explore
