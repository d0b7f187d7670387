#include "hv_explore_sac/train/labels.h"

#include <cmath>

#include <gtest/gtest.h>

#include "hv_core/error.h"
#include "hv_explore_sac/policy/policy_input.h"
#include "policy/random_states.h"
#include "policy/small_policy.h"

namespace hv::explore {
namespace {

Rollout UtilityRollout() {
  return Rollout([](const ExplorationMap&) { return MakePlanner("utility", PlannerInputs()); },
                 GuardConfig());
}

/// What is left to drive when the goal comes first, done again step by step with the public parts.
double DrivenVia(const RandomState& state, const Eigen::Vector2i& goal) {
  DungeonEnvironment environment(state.environment);
  Observation observation;
  bool underway = true;
  const auto planner = MakePlanner("utility", PlannerInputs());
  while (environment.ending() == Ending::kRunning) {
    environment.Observe(observation);
    int wanted = -1;
    for (int i = 0; i < observation.size(); ++i) {
      const Observation::Node& node = observation.node(i);
      if (environment.model().graph().CellOf(node.viewpoint) == goal && node.utility > 0)
        wanted = i;
    }
    underway = underway && wanted >= 0;
    const int action = underway ? observation.FirstHopTo(wanted)
                                : planner->Choose(observation, environment.model()).action;
    environment.Step(observation.node(action).viewpoint);
  }
  return environment.travel() - state.environment.travel();
}

TEST(RolloutTest, DrivesToTheGoalAndThenAsThePlannerDecides) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const RandomState state(seed, 3);
    if (!state.running()) continue;
    const double travel = state.environment.travel();
    GoalSelector selector{PolicyConfig()};
    for (const Goal& goal : selector.Select(state.observation, state.environment.model())) {
      const Eigen::Vector2i cell =
          state.environment.model().graph().CellOf(state.observation.node(goal.node).viewpoint);
      EXPECT_DOUBLE_EQ(UtilityRollout().TravelVia(state.environment, cell), DrivenVia(state, cell));
    }
    EXPECT_EQ(state.environment.travel(), travel);
  }
}

class Labels : public testing::Test {
 protected:
  Labels() : rollout_(UtilityRollout()), sensor_(ExplorationConfig().simulation) {
    for (unsigned seed = 1; seed <= 3; ++seed) maps_.push_back(RandomMap(seed));
    inputs_.labels.share = 0.3;
    inputs_.sensor = &sensor_;
    inputs_.rollout = &rollout_;
  }

  Rollout rollout_;
  RaySensor sensor_;
  std::vector<ExplorationMap> maps_;
  LabelInputs inputs_;
};

TEST_F(Labels, RunsMayStartElsewhere) {
  const auto returns = [&](double elsewhere) {
    inputs_.labels.elsewhere = elsewhere;
    std::vector<float> all;
    for (const LabelledState& label : LabelMap(maps_[0], inputs_, 5)) {
      all.insert(all.end(), label.returns.begin(), label.returns.end());
    }
    return all;
  };
  const std::vector<float> at_start = returns(0.0);
  const std::vector<float> elsewhere = returns(1.0);
  EXPECT_FALSE(at_start.empty());
  EXPECT_FALSE(elsewhere.empty());
  EXPECT_NE(at_start, elsewhere);
  EXPECT_EQ(returns(1.0), elsewhere);
}

TEST_F(Labels, HaveAReturnForEachGoalAndNoneIsFree) {
  for (const ExplorationMap& map : maps_) {
    for (const LabelledState& label : LabelMap(map, inputs_, 7)) {
      const nn::GraphInput input = label.state.Unpack();
      EXPECT_EQ(static_cast<std::size_t>(label.returns.size()), input.actions.size());
      for (Eigen::Index i = 0; i < label.returns.size(); ++i) {
        EXPECT_LT(label.returns[i], 0.0F);
      }
    }
  }
}

TEST_F(Labels, ContendersAloneAreTried) {
  const auto network = RandomNetwork(3, 3.0F);
  inputs_.network = network.get();
  inputs_.temperature = 0.7;
  inputs_.labels.share = 1.0;
  const std::vector<LabelledState> all = LabelMap(maps_[1], inputs_, 3);
  inputs_.labels.contenders = 0.8;
  const std::vector<LabelledState> contended = LabelMap(maps_[1], inputs_, 3);
  ASSERT_FALSE(contended.empty());
  EXPECT_LT(contended.size(), all.size());
  std::size_t at = 0;
  int untried = 0;
  for (const LabelledState& label : contended) {
    const nn::GraphInput input = label.state.Unpack();
    while (at < all.size() && all[at].state.Unpack().features != input.features) ++at;
    ASSERT_LT(at, all.size()) << "the same runs, so the same states";
    const Eigen::ArrayXf preference = 0.7F * network->Choose(input).log_probability.array();
    const Eigen::Array<bool, Eigen::Dynamic, 1> tried =
        preference >= preference.maxCoeff() + 0.7F * std::log(0.8F);
    EXPECT_GT(tried.count(), 1);
    const Eigen::ArrayXf excess = label.returns.array() - preference;
    const float implied = tried.select(excess, 0.0F).sum() / static_cast<float>(tried.count());
    for (Eigen::Index i = 0; i < preference.size(); ++i) {
      if (tried[i]) {
        EXPECT_EQ(label.returns[i], all[at].returns[i]);
      } else {
        EXPECT_NEAR(excess[i], implied, 0.02F);  // features are kept in half precision
        ++untried;
      }
    }
  }
  EXPECT_GT(untried, 0);
}

TEST_F(Labels, OfManyMapsAreThoseOfEachInOrder) {
  std::vector<const ExplorationMap*> maps;
  std::vector<LabelledState> alone;
  for (std::size_t i = 0; i < maps_.size(); ++i) {
    maps.push_back(&maps_[i]);
    for (LabelledState& label : LabelMap(maps_[i], inputs_, 10 + i)) alone.push_back(label);
  }
  const std::vector<LabelledState> all =
      LabelMaps(MapSupply(maps), 0, maps.size(), inputs_, 10, [](double) {});
  ASSERT_EQ(all.size(), alone.size());
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i].returns, alone[i].returns);
}

TEST_F(Labels, SurviveTheirFile) {
  const std::vector<LabelledState> labels = LabelMap(maps_[0], inputs_, 1);
  const std::string path = testing::TempDir() + "labels.bin";
  WriteLabels(labels, path);
  const std::vector<LabelledState> read = ReadLabels(path);
  ASSERT_EQ(read.size(), labels.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].returns, labels[i].returns);
    EXPECT_EQ(read[i].state.Unpack().features, labels[i].state.Unpack().features);
    EXPECT_EQ(read[i].state.Unpack().neighbour, labels[i].state.Unpack().neighbour);
  }
}

}  // namespace
}  // namespace hv::explore
