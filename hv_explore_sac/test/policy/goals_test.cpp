#include "hv_explore_sac/policy/goals.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "hv_explore_sac/planner.h"
#include "hv_explore_sac/policy/goal_tours.h"
#include "random_states.h"

namespace hv::explore {
namespace {

std::set<int> SeenFrom(const RandomState& state, const std::vector<Goal>& goals) {
  std::set<int> all;
  std::vector<int> seen;
  for (const Goal& goal : goals) {
    state.environment.model().views().ListSeen(state.observation.node(goal.node).viewpoint, seen);
    all.insert(seen.begin(), seen.end());
  }
  return all;
}

class Goals : public testing::TestWithParam<unsigned> {};

TEST_P(Goals, TheFirstIsWhatUtilityChooses) {
  const RandomState state(GetParam());
  if (!state.running()) GTEST_SKIP();
  GoalSelector selector{PolicyConfig()};
  const std::vector<Goal>& goals = selector.Select(state.observation, state.environment.model());
  const auto planner = MakePlanner("utility", PlannerInputs());
  const Decision decision = planner->Choose(state.observation, state.environment.model());
  ASSERT_FALSE(goals.empty());
  EXPECT_EQ(goals.front().node, decision.goal);
}

TEST_P(Goals, FreshPointsAddUpToAllThatTheyObserve) {
  const RandomState state(GetParam());
  if (!state.running()) GTEST_SKIP();
  GoalSelector selector{PolicyConfig()};
  const std::vector<Goal>& goals = selector.Select(state.observation, state.environment.model());
  int fresh = 0;
  for (const Goal& goal : goals) {
    EXPECT_GT(goal.fresh, 0);
    EXPECT_GT(state.observation.node(goal.node).utility, 0);
    fresh += goal.fresh;
  }
  EXPECT_EQ(static_cast<std::size_t>(fresh), SeenFrom(state, goals).size());
}

/// Over all orders in which the goals can be visited, this one first.
void BruteForce(const GoalTours& tours, const std::vector<Goal>& goals, int first, float way,
                float& length, float& gain) {
  std::vector<int> order(goals.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  length = GraphSearch::kUnreached;
  gain = 0.0F;
  do {
    if (order.front() != first) continue;
    float driven = way;
    float sum = 0.0F;
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (i > 0) driven += tours.Between(order[i - 1], order[i]);
      const Goal& goal = goals[static_cast<std::size_t>(order[i])];
      sum += static_cast<float>(goal.fresh) * std::exp(-GoalTours::kDecay * driven);
    }
    length = std::min(length, driven);
    gain = std::max(gain, sum);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST_P(Goals, ToursAreTheBestOfAllOrders) {
  const RandomState state(GetParam());
  if (!state.running()) GTEST_SKIP();
  PolicyConfig config;
  config.most_goals = 6;
  GoalSelector selector(config);
  const std::vector<Goal>& goals = selector.Select(state.observation, state.environment.model());
  GoalTours tours;
  tours.Plan(state.observation, state.environment.model(), goals);
  ASSERT_EQ(static_cast<std::size_t>(tours.size()), goals.size());
  for (int first = 0; first < tours.size(); ++first) {
    const int node = goals[static_cast<std::size_t>(first)].node;
    float length = 0.0F;
    float gain = 0.0F;
    BruteForce(tours, goals, first, state.observation.node(node).distance, length, gain);
    EXPECT_NEAR(tours.LengthVia(first), length, 1e-3 * length);
    EXPECT_NEAR(tours.GainVia(first), gain, 1e-4 * gain);
  }
}

INSTANTIATE_TEST_SUITE_P(RandomStates, Goals, testing::Range(1U, 9U));

}  // namespace
}  // namespace hv::explore
