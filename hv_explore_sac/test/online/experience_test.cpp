#include "hv_explore_sac/online/experience.h"

#include <gtest/gtest.h>

#include "hv_explore_sac/dungeon_environment.h"
#include "hv_explore_sac/policy/policy_planner.h"
#include "policy/small_policy.h"
#include "random_maps.h"

namespace hv::explore {
namespace {

RewardConfig Only(double RewardConfig::*term, double weight) {
  RewardConfig reward;
  reward.coverage = reward.frontier = reward.distribution = reward.path = reward.completion = 0.0;
  reward.*term = weight;
  return reward;
}

/// One exploration of a random map by a policy that is not learned, and what was recorded of it.
struct RecordedRun {
  RecordedRun(unsigned seed, const RewardConfig& reward, int cut_after)
      : map(RandomMap(seed)),
        sensor(ExplorationConfig().simulation),
        environment(ExplorationConfig(), reward, sensor, map) {
    ExperienceRecorder recorder(reward, cut_after);
    PolicyPlanner planner(RandomNetwork());
    Observation observation;
    const auto keep = [this](std::optional<nn::Episode> episode) {
      if (episode) episodes.push_back(std::move(*episode));
    };
    while (environment.ending() == Ending::kRunning) {
      environment.Observe(observation);
      const Decision decision = planner.Choose(observation, environment.model());
      keep(recorder.Decide(environment.model(), planner.input(), planner.choice()));
      simulated += environment.Step(observation.node(decision.action).viewpoint).Total();
      ++decisions;
    }
    keep(recorder.End(environment.model()));
  }

  double Sum() const {
    double sum = 0.0;
    for (const nn::Episode& episode : episodes) {
      for (const nn::EpisodeStep& step : episode.steps) sum += static_cast<double>(step.reward);
    }
    return sum;
  }

  ExplorationMap map;
  RaySensor sensor;
  DungeonEnvironment environment;
  std::vector<nn::Episode> episodes;
  double simulated = 0.0;  ///< sum of the rewards that the environment gives
  int decisions = 0;
};

TEST(ExperienceTest, CountsTheWayAndTheEndAsSimulationDoes) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const RecordedRun way(seed, Only(&RewardConfig::path, 1.0), 1000);
    ASSERT_EQ(way.episodes.size(), 1U);
    EXPECT_TRUE(way.episodes[0].done);
    EXPECT_GT(way.episodes[0].steps.size(), 3U);
    EXPECT_NEAR(way.Sum(), way.simulated, 1e-3 * std::abs(way.simulated));
    EXPECT_NEAR(way.Sum(), -way.environment.travel() / RewardConfig().length_scale, 1e-3);
    const RecordedRun end(seed, Only(&RewardConfig::completion, 20.0), 1000);
    EXPECT_EQ(end.episodes.back().steps.back().reward, 20.0F);
    EXPECT_EQ(end.Sum(), 20.0);
  }
}

/// But for those that appear and vanish before the robot has driven on by the spacing.
TEST(ExperienceTest, CountsFrontiersAsSimulationDoes) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const RecordedRun run(seed, Only(&RewardConfig::frontier, 1.0), 1000);
    EXPECT_LE(run.Sum(), run.simulated + 1e-4);
    EXPECT_GT(run.Sum(), 0.85 * run.simulated);
  }
}

TEST(ExperienceTest, WhatIsKnownGrowsToAll) {
  const RecordedRun run(1, Only(&RewardConfig::coverage, 1.0), 1000);
  double unknown = 1.0;
  for (const nn::EpisodeStep& step : run.episodes[0].steps) {
    EXPECT_GE(step.reward, 0.0F);
    EXPECT_LT(step.reward, 1.0F);
    unknown *= 1.0 - static_cast<double>(step.reward);
  }
  EXPECT_LT(unknown, 0.5);  // what the first look showed, as a share of all
}

TEST(ExperienceTest, PartsFollowEachOther) {
  const RecordedRun whole(2, RewardConfig(), 1000);
  const RecordedRun parts(2, RewardConfig(), 3);
  ASSERT_GT(parts.episodes.size(), 2U);
  EXPECT_NEAR(parts.Sum(), whole.Sum(), 1e-4);
  for (std::size_t i = 0; i + 1 < parts.episodes.size(); ++i) {
    EXPECT_EQ(parts.episodes[i].steps.size(), 3U);
    EXPECT_FALSE(parts.episodes[i].done);
    EXPECT_EQ(parts.episodes[i].last.features, parts.episodes[i + 1].steps[0].state.features);
  }
  EXPECT_TRUE(parts.episodes.back().done);
}

TEST(ExperienceTest, WhatIsBrokenOffLeavesOutWhatIsNotKnown) {
  const ExplorationMap map = RandomMap(1);
  const RaySensor sensor{ExplorationConfig().simulation};
  DungeonEnvironment environment(ExplorationConfig(), RewardConfig(), sensor, map);
  ExperienceRecorder recorder(RewardConfig(), 1000);
  PolicyPlanner planner(RandomNetwork());
  Observation observation;
  EXPECT_FALSE(recorder.BreakOff());
  for (int i = 0; i < 3; ++i) {
    environment.Observe(observation);
    const Decision decision = planner.Choose(observation, environment.model());
    recorder.Decide(environment.model(), planner.input(), planner.choice());
    // Decided again on the spot: counts once.
    recorder.Decide(environment.model(), planner.input(), planner.choice());
    environment.Step(observation.node(decision.action).viewpoint);
  }
  const auto episode = recorder.BreakOff();
  ASSERT_TRUE(episode);
  EXPECT_FALSE(episode->done);
  EXPECT_EQ(episode->steps.size(), 2U);
  EXPECT_EQ(episode->last.features, planner.input().features);
  EXPECT_FALSE(recorder.BreakOff());
}

}  // namespace
}  // namespace hv::explore
