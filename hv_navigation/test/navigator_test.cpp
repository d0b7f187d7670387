#include "hv_navigation/navigator.h"

#include <chrono>
#include <cmath>
#include <thread>

#include <gtest/gtest.h>

#include "simulated_site.h"

namespace hv::navigation {
namespace {

/// A corridor of 2 m around a block: the short way from west to east leads along the south.
OccupancyGrid RingCorridor() {
  OccupancyGrid cells = EmptyCells(240, 120, 0.1);
  FenceCells(cells);
  FillCells(cells, {2.1, 2.1}, {21.9, 9.9});
  return cells;
}

/// One corridor of 20 m.
OccupancyGrid DeadStraight() {
  OccupancyGrid cells = EmptyCells(200, 24, 0.1);
  FenceCells(cells);
  return cells;
}

const PlanarPose kWest{{1.1, 1.2}, 0.0};
const PlanarPose kEast{{18.0, 1.2}, 0.0};

bool At(const SimulatedSite& site, const PlanarPose& goal) {
  return (site.robot.pose().position - goal.position).norm() <= 0.1 &&
         std::abs(WrappedAngle(site.robot.pose().yaw - goal.yaw)) <= 0.1;
}

/// Whether a plan passes within 0.5 m of `place`.
bool PassesBy(const NavigationOutput& output, const Eigen::Vector2d& place) {
  if (!output.plan) return false;
  for (const PlanarPose& pose : *output.plan) {
    if ((pose.position - place).norm() < 0.5) return true;
  }
  return false;
}

TEST(NavigatorTest, ReachesAGoalInAnyLocalFrame) {
  SimulatedSite site(DeadStraight(), kWest, {});
  site.T_local_map = {{30.0, -7.0}, 2.2};
  site.navigator.SetGoal(kEast);
  EXPECT_EQ(site.Run(60.0), NavigationResult::kReached) << site.output.reason;
  EXPECT_TRUE(At(site, kEast));
  EXPECT_FALSE(site.collided);
  EXPECT_FALSE(site.navigator.HasGoal());
  EXPECT_EQ(site.Step().state, NavigationState::kIdle);
  EXPECT_FALSE(site.output.result);
}

TEST(NavigatorTest, FollowsCorrectionsOfThePlace) {
  SimulatedSite site(DeadStraight(), kWest, {});
  site.navigator.SetGoal(kEast);
  for (int i = 0; i < 300 && !site.output.result; ++i) {
    if (i % 10 == 0) site.T_local_map = site.T_local_map * PlanarPose{{0.1, -0.05}, 0.02};
    site.Step();
  }
  EXPECT_EQ(site.output.result, NavigationResult::kReached);
  EXPECT_TRUE(At(site, kEast));
}

TEST(NavigatorTest, SaysAtOnceThatThereIsNoPath) {
  OccupancyGrid walled = DeadStraight();
  FillCells(walled, {10.0, 0.0}, {10.3, 2.4});
  SimulatedSite site(walled, kWest, {});
  site.navigator.SetGoal(kEast);
  EXPECT_EQ(site.Run(1.0), NavigationResult::kNoPath);
  EXPECT_FALSE(site.output.reason.empty());
  EXPECT_EQ(site.robot.driven_m(), 0.0);
}

/// A door in which somebody stood when it was seen last.
class DoorThatWasShut : public testing::TestWithParam<bool> {};

TEST_P(DoorThatWasShut, IsLookedAtOnceMore) {
  const bool still = GetParam();
  OccupancyGrid shut = DeadStraight();
  FillCells(shut, {14.0, 0.0}, {14.3, 2.4});
  SimulatedSite site(DeadStraight(), kWest, {});
  site.SetMap(shut);
  site.input.map_has_additions = true;
  site.navigator.SetGoal(kEast);
  int asked = 0;
  for (int i = 0; i < 400 && !site.output.result; ++i) {
    site.Step();
    if (!site.output.forget_additions) continue;
    ++asked;
    site.input.map_has_additions = still;
    if (!still) site.SetMap(DeadStraight());
  }
  EXPECT_EQ(asked, 1);
  EXPECT_EQ(site.output.result, still ? NavigationResult::kNoPath : NavigationResult::kReached);
  if (still) {
    EXPECT_LT(site.time_s, 5.0);
  }
}

INSTANTIATE_TEST_SUITE_P(IsShut, DoorThatWasShut, testing::Bool());

TEST(NavigatorTest, TakesANewGoalWithoutStopping) {
  SimulatedSite site(DeadStraight(), kWest, {});
  site.navigator.SetGoal(kEast);
  while (site.robot.pose().position.x() < 6.0) ASSERT_FALSE(site.Step().result);
  const PlanarPose other{{14.0, 1.5}, 0.4};
  site.navigator.SetGoal(other);
  for (int i = 0; i < 20; ++i) {
    ASSERT_FALSE(site.Step().result);
    EXPECT_GT(site.robot.velocity().linear_mps, 0.5);
  }
  EXPECT_EQ(site.Run(60.0), NavigationResult::kReached);
  EXPECT_TRUE(At(site, other));
}

TEST(NavigatorTest, LeavesTheOldPathWhenTheNewGoalHasNone) {
  SimulatedSite site(DeadStraight(), kWest, {});
  site.navigator.SetGoal(kEast);
  while (site.robot.pose().position.x() < 6.0) site.Step();
  site.navigator.SetGoal({{-50.0, 0.0}, 0.0});
  EXPECT_EQ(site.Run(1.0), NavigationResult::kNoPath);
  for (int i = 0; i < 20; ++i) site.Step();
  EXPECT_EQ(site.robot.velocity().linear_mps, 0.0);
}

TEST(NavigatorTest, GoesRoundABlockedCorridor) {
  SimulatedSite site(RingCorridor(), kWest, {});
  const PlanarPose goal{{22.9, 3.0}, M_PI / 2.0};
  site.navigator.SetGoal(goal);
  while (site.robot.pose().position.x() < 5.0) ASSERT_FALSE(site.Step().result);
  const Eigen::Vector2d blocked(9.0, 1.1);
  ASSERT_TRUE(PassesBy(site.output, blocked));
  FillCells(site.world, {8.8, 0.0}, {9.2, 2.2});
  const double since_s = site.time_s;
  while (PassesBy(site.output, blocked)) {
    ASSERT_FALSE(site.Step().result);
    ASSERT_LT(site.time_s - since_s, 5.0);
  }
  // Out of sight it is not out of mind.
  EXPECT_EQ(site.Run(120.0), NavigationResult::kReached) << site.output.reason;
  EXPECT_TRUE(At(site, goal));
  EXPECT_FALSE(site.collided);
  EXPECT_LT(site.robot.driven_m(), 60.0);
}

TEST(NavigatorTest, ReportsABlockedCorridorAndGoesOnWhenItIsFree) {
  SimulatedSite site(DeadStraight(), kWest, {});
  site.navigator.SetGoal(kEast);
  while (site.robot.pose().position.x() < 5.0) ASSERT_FALSE(site.Step().result);
  const OccupancyGrid free = site.world;
  FillCells(site.world, {8.8, 0.0}, {9.2, 2.4});
  const double since_s = site.time_s;
  while (site.output.reason.empty()) {
    site.Step();
    ASSERT_LT(site.time_s - since_s, 5.0);
  }
  while (site.time_s - since_s < 20.0) ASSERT_FALSE(site.Step().result) << site.output.reason;
  EXPECT_GT(site.output.recoveries, 0);
  site.world = free;
  EXPECT_EQ(site.Run(60.0), NavigationResult::kReached) << site.output.reason;
  EXPECT_FALSE(site.collided);
}

TEST(NavigatorTest, GivesUpOnACorridorThatStaysBlocked) {
  SimulatedSite site(DeadStraight(), kWest, {});
  site.navigator.SetGoal(kEast);
  while (site.robot.pose().position.x() < 5.0) site.Step();
  FillCells(site.world, {8.8, 0.0}, {9.2, 2.4});
  bool cleared = false;
  bool turned = false;
  bool backed = false;
  while (!site.output.result && site.time_s < 200.0) {
    site.Step();
    cleared |= site.output.look_again;
    turned |= site.output.state == NavigationState::kTurning;
    backed |=
        site.output.state == NavigationState::kBackingOff && site.robot.velocity().linear_mps < 0.0;
  }
  EXPECT_EQ(site.output.result, NavigationResult::kBlocked);
  EXPECT_FALSE(site.output.reason.empty());
  EXPECT_TRUE(cleared && turned && backed) << cleared << turned << backed;
  EXPECT_FALSE(site.collided);
}

TEST(NavigatorTest, BacksOutOfAnAlleyWhereItCannotTurn) {
  // The alley, 0.8 m wide, is a dead end.
  OccupancyGrid cells = EmptyCells(120, 60, 0.1);
  FenceCells(cells);
  FillCells(cells, {8.0, 0.0}, {12.0, 2.6});
  FillCells(cells, {8.0, 3.4}, {12.0, 6.0});
  SimulatedSite site(cells, {{10.5, 3.0}, 0.0}, {});
  const PlanarPose goal{{2.0, 3.0}, M_PI};
  site.navigator.SetGoal(goal);
  EXPECT_EQ(site.Run(60.0), NavigationResult::kReached) << site.output.reason;
  EXPECT_TRUE(At(site, goal));
  EXPECT_FALSE(site.collided);
}

/// People stand round the robot: it can neither turn nor back off, and is still there when they go.
TEST(NavigatorTest, WaitsForThoseWhoCrowdIn) {
  SimulatedSite site(DeadStraight(), {{5.05, 1.2}, 0.0}, {});
  for (const double x : {4.3, 5.4}) FillCells(site.world, {x, 0.9}, {x + 0.4, 1.5});
  site.navigator.SetGoal(kWest);
  for (int i = 0; i < 100; ++i) ASSERT_FALSE(site.Step().result) << site.output.reason;
  EXPECT_LT((site.robot.pose().position - Eigen::Vector2d(5.05, 1.2)).norm(), 0.1);
  site.world = DeadStraight();
  EXPECT_EQ(site.Run(60.0), NavigationResult::kReached) << site.output.reason;
  EXPECT_FALSE(site.collided);
}

/// The map holds something at the goal, which is there or not.
class OccupiedGoal : public testing::TestWithParam<bool> {};

TEST_P(OccupiedGoal, IsLookedAtFromNear) {
  const OccupancyGrid free = DeadStraight();
  OccupancyGrid occupied = free;
  FillCells(occupied, {17.6, 0.8}, {18.4, 1.6});
  SimulatedSite site(occupied, kWest, {});
  if (!GetParam()) site.world = free;
  site.navigator.SetGoal(kEast);
  while (site.robot.pose().position.x() < 15.0) ASSERT_FALSE(site.Step().result);
  // So does whatever makes the map of what is seen.
  if (!GetParam()) site.SetMap(free);
  site.Run(60.0);
  EXPECT_EQ(site.output.result,
            GetParam() ? NavigationResult::kNoPath : NavigationResult::kReached);
  EXPECT_EQ(At(site, kEast), !GetParam());
  EXPECT_EQ(site.output.reason.find("the goal is in") != std::string::npos, GetParam());
  EXPECT_GT(site.robot.pose().position.x(), 16.0);
  EXPECT_FALSE(site.collided);
}

INSTANTIATE_TEST_SUITE_P(IsThere, OccupiedGoal, testing::Bool());

TEST(NavigatorTest, SaysThatItIsShutIn) {
  OccupancyGrid cells = EmptyCells(120, 60, 0.1);
  FenceCells(cells);
  FillCells(cells, {7.0, 0.0}, {12.0, 2.6});
  FillCells(cells, {7.0, 3.4}, {12.0, 6.0});
  FillCells(cells, {7.0, 2.6}, {9.0, 3.4});
  SimulatedSite site(cells, {{10.5, 3.0}, 0.0}, {});
  site.navigator.SetGoal({{11.4, 3.0}, M_PI});
  EXPECT_EQ(site.Run(100.0), NavigationResult::kBlocked);
  EXPECT_NE(site.output.reason.find("no room to turn"), std::string::npos) << site.output.reason;
  EXPECT_FALSE(site.collided);
}

TEST(NavigatorTest, ForgetsGhostsToGetOn) {
  SimulatedSite site(DeadStraight(), kWest, {});
  site.navigator.SetGoal(kEast);
  for (double y = 0.2; y < 2.4; y += 0.2) site.ghosts.emplace_back(9.0, y);
  EXPECT_EQ(site.Run(90.0), NavigationResult::kReached) << site.output.reason;
  EXPECT_TRUE(site.ghosts.empty());
}

class InputLoss : public testing::TestWithParam<int> {};

TEST_P(InputLoss, StopsWithinACycleResumesAndGivesUp) {
  PlanningConfig config;
  SimulatedSite site(DeadStraight(), kWest, config);
  site.navigator.SetGoal(kEast);
  const auto lose = [&](bool lost) {
    if (GetParam() == 0) site.sees = !lost;
    if (GetParam() == 1) site.input.localized = !lost;
  };
  while (site.robot.pose().position.x() < 6.0) site.Step();
  lose(true);
  double last_mps = site.robot.velocity().linear_mps;
  while (site.Step().state != NavigationState::kPaused) {
    last_mps = site.robot.velocity().linear_mps;
    // Silence is noticed after the timeout, everything else at once.
    ASSERT_EQ(GetParam(), 0);
    ASSERT_LT(site.input.now - site.input.pose_stamp, config.navigator.pose_timeout_s + 0.05);
  }
  EXPECT_NEAR(last_mps - site.output.velocity.linear_mps,
              std::min(last_mps, config.limits.linear_braking_mps2 * 0.1), 1e-6);
  EXPECT_FALSE(site.output.reason.empty());
  for (int i = 0; i < 15; ++i) site.Step();
  EXPECT_EQ(site.robot.velocity().linear_mps, 0.0);
  lose(false);
  for (int i = 0; i < 20; ++i) site.Step();
  EXPECT_GT(site.robot.velocity().linear_mps, 0.3);
  lose(true);
  EXPECT_EQ(site.Run(config.navigator.inputs_lost_s + 2.0), NavigationResult::kInputsLost);
}

INSTANTIATE_TEST_SUITE_P(Inputs, InputLoss, testing::Values(0, 1));

TEST(NavigatorTest, CancelBrakes) {
  SimulatedSite site(DeadStraight(), kWest, {});
  site.navigator.SetGoal(kEast);
  while (site.robot.pose().position.x() < 4.0) site.Step();
  const double before_mps = site.robot.velocity().linear_mps;
  site.navigator.Cancel();
  EXPECT_EQ(site.Step().result, NavigationResult::kCancelled);
  EXPECT_LT(site.output.velocity.linear_mps, before_mps);
  for (int i = 0; i < 15; ++i) site.Step();
  EXPECT_EQ(site.robot.velocity().linear_mps, 0.0);
}

/// Odometry tells a velocity of a moment ago.
TEST(NavigatorTest, BrakesByWhatItAsksForWhenMeasuringLags) {
  const PlanningConfig config;
  SimulatedSite site(DeadStraight(), kWest, config);
  site.navigator.SetGoal(kEast);
  while (site.robot.pose().position.x() < 6.0) site.Step();
  const double from_mps = site.robot.velocity().linear_mps;
  ASSERT_GT(from_mps, 0.9);
  site.velocity_lag = 0.3;
  site.navigator.Cancel();
  const double period_s = config.local.period_s;
  const int cycles =
      static_cast<int>(std::ceil(from_mps / (config.limits.linear_braking_mps2 * period_s)));
  for (int i = 0; i < cycles; ++i) site.Step();
  EXPECT_EQ(site.robot.velocity().linear_mps, 0.0);
}

TEST(NavigatorTest, IsDeterministic) {
  SimulatedSite a(RingCorridor(), kWest, {});
  SimulatedSite b(RingCorridor(), kWest, {});
  a.navigator.SetGoal(kEast);
  b.navigator.SetGoal(kEast);
  for (int i = 0; i < 150; ++i) {
    if (i == 60) FillCells(a.world, {9.0, 0.0}, {9.4, 1.0});
    if (i == 60) FillCells(b.world, {9.0, 0.0}, {9.4, 1.0});
    a.Step();
    b.Step();
    ASSERT_EQ(a.robot.pose().position, b.robot.pose().position) << i;
  }
  EXPECT_GT(a.robot.driven_m(), 5.0);
}

TEST(NavigatorTest, PlansInTheBackground) {
  SimulatedSite site(DeadStraight(), kWest, {}, PlanningWorker::Mode::kInBackground);
  site.navigator.SetGoal(kEast);
  EXPECT_EQ(site.Step().state, NavigationState::kPlanning);
  for (int i = 0; i < 20000 && !site.output.result; ++i) {
    site.Step();
    // The robot's time runs faster than the planner's.
    if (!site.output.plan) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(site.output.result, NavigationResult::kReached) << site.output.reason;
}

TEST(PlanningConfigTest, DefaultsAreValidAndDescribed) {
  PlanningConfig config;
  ConfigProblems problems;
  config.Validate(problems);
  EXPECT_TRUE(problems.lines().empty());
  const std::string yaml = ToYaml(config);
  for (const char* key : {"margin_m", "max_linear_mps", "samples", "horizon_s", "give_up_s"}) {
    EXPECT_NE(yaml.find(key), std::string::npos) << key;
  }
  config.local.turns = 1;
  config.global.max_detour = 0.5;
  config.limits.max_linear_mps = -1.0;
  ConfigProblems found;
  config.Validate(found);
  EXPECT_GE(found.lines().size(), 3U);
}

TEST(NavigatorTest, PlansLeadThroughThoseWhoWalk) {
  SimulatedSite site(RingCorridor(), kWest, {});
  const PlanarPose east{{20.0, 1.2}, 0.0};
  site.navigator.SetGoal(east);
  site.Step();
  ASSERT_TRUE(PassesBy(site.output, {12.0, 1.2}));
  for (double y = 0.2; y < 2.1; y += 0.1) site.ghosts.emplace_back(4.5, y);
  SimulatedSite told(RingCorridor(), kWest, {});
  told.navigator.SetGoal(east);
  OccupancyGrid nobody = EmptyCells(200, 200, 0.05);
  nobody.origin = {-4.0, -4.0};
  told.input.standing_grid =
      std::make_shared<const ClearanceGrid>(nobody, ClearanceGrid::Unknown::kFree, 1.5);
  told.ghosts = site.ghosts;
  for (int i = 0; i < 50; ++i) {
    site.Step();
    told.Step();
    EXPECT_TRUE(PassesBy(told.output, {12.0, 1.2})) << i;
  }
  EXPECT_FALSE(PassesBy(site.output, {12.0, 1.2}));
  EXPECT_FALSE(told.collided);
  EXPECT_LT(told.robot.pose().position.x(), 4.3);
}

}  // namespace
}  // namespace hv::navigation
