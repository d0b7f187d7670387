#include "hv_explore_sac/explorer.h"

#include <gtest/gtest.h>

#include "toy_exploration.h"

namespace hv::explore {
namespace {

bool InLeftRoom(const Eigen::Vector2d& position) {
  return position.x() < 5.2 && position.y() > 2.5;
}

TEST(ExplorerTest, ExploresEveryRoom) {
  Exploration exploration;
  exploration.explorer.Start({});
  const ExplorationResult result = exploration.Run();
  EXPECT_EQ(result.end, ExplorationEnd::kExplored);
  EXPECT_TRUE(result.success);
  EXPECT_EQ(result.reason, "explored: no frontiers are left");
  EXPECT_GT(result.progress.explored_m2, 0.97 * FreeArea(TwoRooms(), {}));
  EXPECT_GT(result.progress.travelled_m, 3.0);
  EXPECT_LT(result.progress.travelled_m, 40.0);
  EXPECT_EQ(result.progress.failed_goals, 0);
  EXPECT_EQ(result.progress.goals, static_cast<int>(exploration.goals.size()));
  EXPECT_FALSE(exploration.explorer.Active());
}

class Planning : public testing::TestWithParam<std::string> {};

TEST_P(Planning, ExploresAndIsDeterministic) {
  ExplorerConfig config;
  config.choice.planner = GetParam();
  std::vector<std::vector<navigation::PlanarPose>> goals;
  for (int i = 0; i < 2; ++i) {
    Exploration exploration(config);
    exploration.explorer.Start({});
    EXPECT_TRUE(exploration.Run().success);
    goals.push_back(exploration.goals);
  }
  ASSERT_EQ(goals[0].size(), goals[1].size());
  for (std::size_t i = 0; i < goals[0].size(); ++i) {
    EXPECT_EQ(goals[0][i].position, goals[1][i].position);
    EXPECT_EQ(goals[0][i].yaw, goals[1][i].yaw);
  }
}

INSTANTIATE_TEST_SUITE_P(OfRobots, Planning,
                         testing::Values("nearest", "utility", "ratio", "tour", "branch"),
                         [](const auto& name) { return name.param; });

TEST(ExplorerTest, ReturnsHomeInTheEnd) {
  Exploration exploration;
  const navigation::PlanarPose home = exploration.robot.pose();
  exploration.explorer.Start({{}, 0.0, true});
  const ExplorationResult result = exploration.Run();
  EXPECT_TRUE(result.success) << result.reason;
  EXPECT_EQ(exploration.goals.back().position, home.position);
  EXPECT_LT((exploration.robot.pose().position - home.position).norm(), 0.1);
}

TEST(ExplorerTest, TellsWhenItDidNotGetHome) {
  ExplorerConfig config;
  Exploration exploration(config);
  const Eigen::Vector2d home = exploration.robot.pose().position;
  exploration.refuses = [home](const auto& goal) { return (goal - home).norm() < 0.01; };
  exploration.explorer.Start({{}, 0.0, true});
  const ExplorationResult result = exploration.Run();
  EXPECT_EQ(result.end, ExplorationEnd::kExplored);
  EXPECT_FALSE(result.success);
  EXPECT_EQ(result.reason, "explored: no frontiers are left; the way home failed: no path");
  int tries = 0;
  for (const auto& goal : exploration.goals) tries += (goal.position - home).norm() < 0.01;
  EXPECT_EQ(tries, config.goals.home_tries);
}

TEST(ExplorerTest, EndsWhenTheTimeIsUpAndStillReturns) {
  Exploration exploration;
  exploration.explorer.Start({{}, 5.0, true});
  const Eigen::Vector2d home = exploration.robot.pose().position;
  const ExplorationResult result = exploration.Run();
  EXPECT_EQ(result.end, ExplorationEnd::kOutOfTime);
  EXPECT_FALSE(result.success);
  EXPECT_EQ(result.reason, "out of time");
  EXPECT_EQ(exploration.goals.back().position, home);
  EXPECT_GE(result.progress.elapsed_s, 5.0);
}

TEST(ExplorerTest, LeavesAloneWhatCannotBeReached) {
  ExplorerConfig config;
  config.goals.refused_radius_m = 2.5;
  Exploration exploration(config);
  exploration.refuses = InLeftRoom;
  exploration.explorer.Start({});
  const ExplorationResult result = exploration.Run();
  EXPECT_EQ(result.end, ExplorationEnd::kUnreachable);
  EXPECT_TRUE(result.success);
  EXPECT_EQ(result.reason, "nothing is left that can be reached; no path");
  EXPECT_GE(result.progress.failed_goals, 2);  // each place gets a second chance
  EXPECT_GT(result.progress.explored_m2, 50.0);
}

TEST(ExplorerTest, EndsWhenNavigationFailsAtEveryGoal) {
  ExplorerConfig config;
  config.goals.failures = 4;
  config.goals.refused_radius_m = 0.0;
  Exploration exploration(config);
  exploration.refuses = [](const auto&) { return true; };
  exploration.explorer.Start({});
  const ExplorationResult result = exploration.Run();
  EXPECT_EQ(result.end, ExplorationEnd::kNavigationFails);
  EXPECT_FALSE(result.success);
  EXPECT_EQ(result.progress.failed_goals, config.goals.failures);
  EXPECT_EQ(result.reason, "navigation fails; no path");
}

TEST(ExplorerTest, ARobotThatDoesNotGetOnHasFailed) {
  ExplorerConfig config;
  config.goals.stuck_s = 10.0;
  config.goals.failures = 2;
  config.goals.refused_radius_m = 0.0;
  Exploration exploration(config);
  exploration.drives = false;
  exploration.explorer.Start({});
  const ExplorationResult result = exploration.Run();
  EXPECT_EQ(result.end, ExplorationEnd::kNavigationFails);
  EXPECT_NEAR(result.progress.elapsed_s, 20.0, 4.0);
}

TEST(ExplorerTest, StopsWhenCancelled) {
  Exploration exploration;
  exploration.explorer.Start({{}, 0.0, true});
  for (int i = 0; i < 4; ++i) exploration.Step();
  ASSERT_TRUE(exploration.goal);
  exploration.explorer.Cancel();
  const ExplorerOutput output = exploration.Step();
  ASSERT_TRUE(output.result);
  EXPECT_EQ(output.result->end, ExplorationEnd::kCancelled);
  EXPECT_TRUE(output.stop);
  EXPECT_FALSE(output.goal);
}

TEST(ExplorerTest, PausesAndGoesOn) {
  Exploration exploration;
  exploration.explorer.Start({});
  for (int i = 0; i < 4; ++i) exploration.Step();
  ASSERT_TRUE(exploration.goal);
  exploration.explorer.SetPaused(true);
  EXPECT_TRUE(exploration.Step().stop);
  const double elapsed_s = exploration.explorer.progress().elapsed_s;
  const std::size_t goals = exploration.goals.size();
  for (int i = 0; i < 10; ++i) {
    const ExplorerOutput output = exploration.Step();
    EXPECT_EQ(output.state, ExplorerState::kPaused);
    EXPECT_FALSE(output.stop);
  }
  EXPECT_EQ(exploration.goals.size(), goals);
  EXPECT_EQ(exploration.explorer.progress().elapsed_s, elapsed_s);
  exploration.explorer.SetPaused(false);
  EXPECT_TRUE(exploration.Step().goal);
  EXPECT_TRUE(exploration.Run().success);
}

TEST(ExplorerTest, GoesOnHomeAfterAPause) {
  ExplorerConfig config;
  config.goals.home_tries = 1;
  Exploration exploration(config);
  exploration.explorer.Start({{}, 5.0, true});
  while (exploration.Step().state != ExplorerState::kReturning) {
  }
  exploration.Step();
  exploration.explorer.SetPaused(true);
  exploration.Step();
  exploration.explorer.SetPaused(false);
  EXPECT_EQ(exploration.Run().reason, "out of time");
}

TEST(ExplorerTest, StaysInsideOfTheBounds) {
  const Bounds bounds({{0.0, 0.0}, {12.0, 0.0}, {12.0, 2.6}, {0.0, 2.6}});
  Exploration exploration;
  exploration.explorer.Start({bounds, 0.0, false});
  const ExplorationResult result = exploration.Run();
  EXPECT_EQ(result.end, ExplorationEnd::kExplored);
  for (const auto& goal : exploration.goals) EXPECT_TRUE(bounds.Contains(goal.position));
  EXPECT_LT(result.progress.explored_m2, 22.0);
}

TEST(ExplorerTest, DoesNotExploreFromOutsideOfTheBounds) {
  ExplorerConfig config;
  config.goals.inputs_lost_s = 8.0;
  Exploration exploration(config);
  exploration.explorer.Start({Bounds({{0.0, 4.0}, {5.0, 4.0}, {5.0, 8.0}, {0.0, 8.0}}), 0.0, true});
  const ExplorationResult result = exploration.Run();
  EXPECT_EQ(result.end, ExplorationEnd::kNoFreePlace);
  EXPECT_FALSE(result.success);
  EXPECT_TRUE(exploration.goals.empty());
}

TEST(ExplorerTest, WaitsForItsInputsButNotForEver) {
  ExplorerConfig config;
  config.goals.inputs_lost_s = 8.0;
  Exploration exploration(config);
  exploration.has_map = false;
  exploration.explorer.Start({});
  for (int i = 0; i < 10; ++i) EXPECT_EQ(exploration.Step().state, ExplorerState::kWaiting);
  exploration.has_map = true;
  EXPECT_TRUE(exploration.Step().goal);
  exploration.has_place = false;
  const ExplorationResult result = exploration.Run();
  EXPECT_EQ(result.end, ExplorationEnd::kInputsLost);
  EXPECT_EQ(result.reason, "inputs lost; the place in the map is not known");
}

TEST(ExplorerTest, AJumpOfTheClockCountsNothing) {
  Exploration exploration;
  exploration.explorer.Start({});
  exploration.Step();
  exploration.time_s += 1e6;
  exploration.Step();
  exploration.time_s -= 2e6;
  exploration.Step();
  EXPECT_LT(exploration.explorer.progress().elapsed_s, 2.0);
  EXPECT_TRUE(exploration.Run().success);
}

/// Chooses the nearest and the farthest viewpoint in turn.
class Waverer : public Planner {
 public:
  Decision Choose(const Observation& observation, const ExplorationModel&) override {
    std::vector<int> useful;
    for (int i = 0; i < observation.size(); ++i) {
      if (observation.node(i).utility > 0) useful.push_back(i);
    }
    const int goal = ++decisions_ % 2 == 0 ? useful.front() : useful.back();
    return {observation.FirstHopTo(goal), goal};
  }

 private:
  int decisions_ = 0;
};

TEST(ExplorerTest, KeepsItsGoalWhenThePlannerWavers) {
  Exploration exploration({}, [](const PlannerInputs&) { return std::make_unique<Waverer>(); });
  exploration.drives = false;
  exploration.explorer.Start({});
  for (int i = 0; i < 40; ++i) exploration.Step();
  EXPECT_EQ(exploration.goals.size(), 1U);
}

/// Chooses the farthest viewpoint from the fifth decision on.
class LateMind : public Planner {
 public:
  Decision Choose(const Observation& observation, const ExplorationModel&) override {
    int goal = 0;
    for (int i = 0; i < observation.size(); ++i) {
      if (observation.node(i).utility == 0) continue;
      goal = i;
      if (decisions_ < 4) break;
    }
    ++decisions_;
    return {observation.FirstHopTo(goal), goal};
  }

 private:
  int decisions_ = 0;
};

TEST(ExplorerTest, TakesAnotherGoalThatThePlannerInsistsOn) {
  ExplorerConfig config;
  config.choice.insist = 3;
  Exploration exploration(config,
                          [](const PlannerInputs&) { return std::make_unique<LateMind>(); });
  exploration.drives = false;
  exploration.explorer.Start({});
  std::vector<double> changes_s;
  for (int i = 0; i < 40; ++i) {
    if (exploration.Step().goal) changes_s.push_back(exploration.explorer.progress().elapsed_s);
  }
  ASSERT_EQ(changes_s.size(), 2U);
  EXPECT_NEAR(changes_s[1] - changes_s[0], 6.0 * config.choice.period_s, 1e-6);
}

TEST(ExplorerTest, TasksAreChecked) {
  EXPECT_EQ(ProblemOf({}), "");
  EXPECT_NE(ProblemOf({{}, -1.0, false}).find("time budget"), std::string::npos);
  EXPECT_NE(ProblemOf({{}, NAN, false}).find("time budget"), std::string::npos);
  EXPECT_NE(ProblemOf({Bounds({{0.0, 0.0}, {1.0, 0.0}}), 0.0, false}), "");
}

TEST(ExplorerConfigTest, IsGivenInMetresAndUsedInCells) {
  ExplorerConfig config;
  config.places.frontier_m = 0.4;
  config.places.spacing_m = 1.0;
  config.choice.utility_decay = 0.2;
  const ExplorationConfig cells = config.InCells(0.05);
  EXPECT_EQ(cells.frontier.block, 8);
  EXPECT_DOUBLE_EQ(cells.viewpoint.spacing_x, 20.0);
  EXPECT_DOUBLE_EQ(cells.viewpoint.spacing_y, 20.0);
  EXPECT_DOUBLE_EQ(config.PlannerInCells(0.05).utility_decay, 0.01);
  EXPECT_EQ(config.InCells(5.0).frontier.block, 1);
}

TEST(ExplorerConfigTest, RefusesPlannersThatNeedATrueMap) {
  RobotExplorationConfig config;
  ConfigProblems none;
  config.Validate(none);
  EXPECT_TRUE(none.lines().empty());
  config.explorer.choice.planner = "oracle";
  ConfigProblems problems;
  config.Validate(problems);
  ASSERT_EQ(problems.lines().size(), 1U);
  EXPECT_NE(problems.lines()[0].find("nearest, utility"), std::string::npos);
}

TEST(ExplorerConfigTest, ALearnedPlannerNeedsWeights) {
  RobotExplorationConfig config;
  config.explorer.choice.planner = kLearnedPlanner;
  ConfigProblems without;
  config.Validate(without);
  ASSERT_EQ(without.lines().size(), 1U);
  EXPECT_EQ(without.lines()[0].find("choice.weights"), 0U);
  config.explorer.choice.weights = "policy.bin";
  ConfigProblems with;
  config.Validate(with);
  EXPECT_TRUE(with.lines().empty());
}

}  // namespace
}  // namespace hv::explore
