#include "hv_explore_sac/planner.h"

#include <cstdlib>
#include <utility>

#include <gtest/gtest.h>

#include "hv_core/error.h"
#include "hv_explore_sac/exploration_run.h"
#include "hv_explore_sac/graph_search.h"
#include "random_maps.h"

namespace hv::explore {
namespace {

std::vector<ExplorationMap> SomeMaps() {
  std::vector<ExplorationMap> maps;
  for (unsigned seed = 1; seed <= 6; ++seed) maps.push_back(RandomMap(seed));
  return maps;
}

double MeanTravel(const std::vector<RunResult>& results) {
  double sum = 0.0;
  for (const RunResult& result : results) sum += result.travel;
  return sum / static_cast<double>(results.size());
}

std::vector<RunResult> RunAll(const std::string& planner, int threads = 1) {
  EvaluationConfig config;
  config.threads = threads;
  return Evaluate(SomeMaps(), {planner}, config, [](std::size_t, std::size_t) {});
}

class Planners : public testing::TestWithParam<std::string> {};

TEST_P(Planners, ExploreEveryMap) {
  for (const RunResult& result : RunAll(GetParam())) {
    EXPECT_TRUE(result.done) << result.map;
    EXPECT_GE(result.explored, 0.98) << result.map;
  }
}

TEST_P(Planners, AreDeterministicWhateverTheThreads) {
  const std::vector<RunResult> once = RunAll(GetParam());
  const std::vector<RunResult> again = RunAll(GetParam(), 3);
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].map, again[i].map);
    EXPECT_EQ(once[i].path, again[i].path);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Planners, testing::ValuesIn(PlannerNames()),
                         [](const auto& name) { return name.param; });

TEST(PlannerTest, KnowingTheMapIsWorthIt) {
  const double oracle = MeanTravel(RunAll("oracle"));
  EXPECT_LT(oracle, 0.95 * MeanTravel(RunAll("nearest")));
  EXPECT_LT(oracle, 0.95 * MeanTravel(RunAll("utility")));
}

TEST(PlannerTest, UnknownNamesAreRefused) {
  EXPECT_THROW(MakePlanner("best", PlannerInputs()), InputError);
}

/// A corridor from which two halls lead down, both open to the unknown at their ends. Of the four
/// viewpoints around it each has edges to two only, so that no edge leads up again.
ExplorationModel TwoWaysDown() {
  ExplorationConfig config;
  config.viewpoint.spacing_x = config.viewpoint.spacing_y = 10.0;
  config.viewpoint.neighbors = 2;
  ExplorationModel model(config, 200, 200);
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) {
      const bool in_hall = std::abs(x - 35) < 14 || std::abs(x - 155) < 14;
      const bool in_corridor = y >= 152 && y < 168 && x >= 12 && x < 188;
      Cell cell = in_corridor || (in_hall && y < 152) ? Cell::kFree : Cell::kOccupied;
      if (in_hall && y < 52) cell = Cell::kUnknown;
      model.belief().Set(model.belief().IndexOf({x, y}), cell);
    }
  }
  model.Update({100, 160});
  return model;
}

TEST(PlannerTest, ToursGoByWayOfTheRobotWhereNothingElseLeads) {
  const ExplorationModel model = TwoWaysDown();
  Observation observation;
  model.Observe(observation);
  const int left = model.graph().At({30, 60});
  const int right = model.graph().At({150, 60});
  ASSERT_TRUE(model.ways().Reached(left) && model.ways().Reached(right));
  GraphSearch search;
  for (const auto& [from, to] : {std::pair(left, right), std::pair(right, left)}) {
    search.Run(model.graph(), from);
    ASSERT_FALSE(search.Reached(to));
  }
  const Decision decision = MakePlanner("tour", PlannerInputs())->Choose(observation, model);
  EXPECT_GT(observation.node(decision.goal).utility, 0);
}

/// Drives to and fro between the start and its nearest neighbour.
TEST(LoopGuardTest, BreaksLoopsAndEndsTheExploration) {
  EvaluationConfig config;
  const ExplorationMap map = RandomMap(2);
  const RaySensor sensor(config.exploration.simulation);
  DungeonEnvironment environment(config.exploration, RewardConfig(), sensor, map);
  LoopGuard guard(config.guard);
  Observation observation;
  while (environment.ending() == Ending::kRunning) {
    environment.Observe(observation);
    const int nearest = observation.Actions()[0].to;
    const Decision decision = guard.Review({nearest, nearest}, observation, environment.model());
    environment.Step(observation.node(decision.action).viewpoint);
  }
  EXPECT_TRUE(environment.complete());
  EXPECT_GT(guard.interventions(), 0);
}

TEST(LoopGuardTest, LeavesOthersAlone) {
  for (const RunResult& result : RunAll("utility")) EXPECT_EQ(result.interventions, 0);
}

TEST(RefusedGoalsTest, AreLeftAloneUntilTheyExpire) {
  ExplorationConfig config;
  const ExplorationMap map = RandomMap(2);
  ExplorationModel model(config, map.width, map.height);
  RaySensor(config.simulation).Sense(map, map.start, model.belief());
  model.Update(map.start);
  Observation observation;
  model.Observe(observation);
  int goal = 0;
  while (observation.node(goal).utility == 0) ++goal;
  GuardConfig guard;
  guard.refused_for = 3;
  guard.refused_radius = 1.0;
  RefusedGoals refused(guard);
  refused.Refuse(model.graph().CellOf(observation.node(goal).viewpoint));
  for (int decision = 1; decision <= 5; ++decision) {
    model.Observe(observation);
    const bool left_alone = decision <= 3;
    EXPECT_EQ(refused.Apply(observation, model), left_alone ? 1 : 0);
    EXPECT_EQ(observation.node(goal).utility == 0, left_alone);
  }
}

}  // namespace
}  // namespace hv::explore
