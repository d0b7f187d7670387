#include "hv_explore_sac/dungeon_environment.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "random_maps.h"

namespace hv::explore {
namespace {

class Dungeon : public testing::TestWithParam<unsigned> {
 protected:
  const ExplorationConfig config_;
  const RaySensor sensor_{config_.simulation};
  const ExplorationMap map_ = RandomMap(GetParam());
};

TEST_P(Dungeon, RewardsAddUpAndTravelIsThePath) {
  RewardConfig weights;
  weights.distribution = 0.5;
  DungeonEnvironment environment(config_, weights, sensor_, map_);
  const double explored_at_start = environment.explored();
  Reward sum;
  std::mt19937 random(GetParam());
  while (environment.ending() == Ending::kRunning) {
    const auto& edges = environment.model().graph().EdgesOf(environment.model().robot());
    const auto next = std::uniform_int_distribution<std::size_t>(0, edges.size() - 1)(random);
    const Reward reward = environment.Step(edges[next].to);
    EXPECT_GE(reward.coverage, 0.0);
    EXPECT_GE(reward.frontier, 0.0);
    EXPECT_GE(reward.distribution, 0.0);
    EXPECT_LT(reward.path, 0.0);
    EXPECT_EQ(reward.completion > 0.0, environment.complete());
    sum.coverage += reward.coverage;
    sum.path += reward.path;
  }
  double length = 0.0;
  for (std::size_t i = 1; i < environment.path().size(); ++i) {
    length += (environment.path()[i] - environment.path()[i - 1]).cast<double>().norm();
  }
  EXPECT_NEAR(environment.travel(), length, 1e-3);
  EXPECT_NEAR(sum.path, -weights.path * length / weights.length_scale, 1e-4);
  EXPECT_NEAR(sum.coverage, weights.coverage * (environment.explored() - explored_at_start), 1e-9);
}

TEST_P(Dungeon, RefusesToDriveWhereNoEdgeLeads) {
  DungeonEnvironment environment(config_, RewardConfig(), sensor_, map_);
  EXPECT_THROW(environment.Step(environment.model().robot()), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(Maps, Dungeon, testing::Range(1U, 5U));

TEST(DungeonTest, IsGivenUpAfterTooManyDecisions) {
  ExplorationConfig config;
  config.simulation.max_steps = 3;
  const RaySensor sensor(config.simulation);
  const ExplorationMap map = RandomMap(3);
  DungeonEnvironment environment(config, RewardConfig(), sensor, map);
  while (environment.ending() == Ending::kRunning) {
    environment.Step(environment.model().graph().EdgesOf(environment.model().robot())[0].to);
  }
  EXPECT_EQ(environment.ending(), Ending::kGivenUp);
  EXPECT_FALSE(environment.complete());
  EXPECT_EQ(environment.steps(), 3);
}

TEST(RewardTest, EachTermHasItsWeightAndSign) {
  RewardConfig config;
  config.coverage = 2.0;
  config.frontier = 3.0;
  config.distribution = 5.0;
  config.path = 7.0;
  config.completion = 11.0;
  config.frontier_scale = 10.0;
  config.length_scale = 4.0;
  Transition transition;
  transition.explored_before = 0.25;
  transition.explored_after = 0.75;
  transition.frontiers_observed = 20;
  transition.has_centroids = true;
  transition.centroid_after = {6.0, 8.0};
  transition.path = 12.0;
  transition.complete = true;
  const Reward reward = RewardOf(transition, config);
  EXPECT_DOUBLE_EQ(reward.coverage, 1.0);
  EXPECT_DOUBLE_EQ(reward.frontier, 6.0);
  EXPECT_DOUBLE_EQ(reward.distribution, 12.5);
  EXPECT_DOUBLE_EQ(reward.path, -21.0);
  EXPECT_DOUBLE_EQ(reward.completion, 11.0);
  EXPECT_DOUBLE_EQ(reward.Total(), 9.5);
  transition.has_centroids = false;
  EXPECT_DOUBLE_EQ(RewardOf(transition, config).distribution, 0.0);
}

}  // namespace
}  // namespace hv::explore
