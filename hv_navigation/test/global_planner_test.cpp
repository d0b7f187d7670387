#include "hv_navigation/global_planner.h"

#include <cmath>

#include <gtest/gtest.h>

#include "grids.h"

namespace hv::navigation {
namespace {

constexpr double kLimit_m = 2.0;

ClearanceGrid Clearances(const OccupancyGrid& cells) {
  return ClearanceGrid(cells, ClearanceGrid::Unknown::kOccupied, kLimit_m);
}

/// A robot that turns wherever it fits: what the inflated grid says holds exactly.
Footprint Slim() {
  Footprint footprint;
  footprint.front_m = footprint.back_m = footprint.half_width_m = 0.1;
  footprint.margin_m = 0.0;
  return footprint;
}

/// Poses of a path are close enough together for a check of each to be one of the whole.
void ExpectDrivable(const Path& path, const ClearanceGrid& grid, const Footprint& footprint) {
  for (std::size_t i = 0; i < path.size(); ++i) {
    EXPECT_FALSE(footprint.Collides(grid, path[i])) << i << ": " << path[i].position.transpose();
    if (i == 0) continue;
    const Eigen::Vector2d way = path[i].position - path[i - 1].position;
    const double turn = WrappedAngle(path[i].yaw - path[i - 1].yaw);
    EXPECT_LT(way.norm(), 0.11);
    EXPECT_LT(std::abs(turn), 0.21);
    if (way.norm() < 1e-9) continue;
    // It drives the way it looks: along the chord of an arc, so to say.
    const double heading = std::atan2(way.y(), way.x());
    const double middle = path[i - 1].yaw + 0.5 * turn;
    EXPECT_NEAR(WrappedAngle(heading - middle), 0.0, 0.01) << i;
  }
}

void ExpectSamePose(const PlanarPose& a, const PlanarPose& b) {
  EXPECT_LT((a.position - b.position).norm(), 1e-9);
  EXPECT_NEAR(WrappedAngle(a.yaw - b.yaw), 0.0, 1e-9);
}

class RandomRooms : public testing::TestWithParam<unsigned> {};

TEST_P(RandomRooms, FindsAPathIffTheInflatedGridHasOne) {
  const ClearanceGrid grid = Clearances(RandomRoom(8.0, 45, 0.1, GetParam()));
  const Footprint footprint = Slim();
  const double open_m = footprint.CircumscribedRadius() + 0.11;
  const GlobalPlanner planner({}, footprint);
  for (unsigned i = 0; i < 6; ++i) {
    const Eigen::Vector2i start = OpenCell(grid, open_m, 10 * GetParam() + i);
    const Eigen::Vector2i goal = OpenCell(grid, open_m, 7000 + 10 * GetParam() + i);
    const auto truth = DijkstraLengths(grid, footprint.InscribedRadius(), start);
    const double shortest_m = truth[CellIndex(grid, goal)];
    PlanRequest request;
    request.start = {grid.CenterOf(start), 1.0};
    request.goal = {grid.CenterOf(goal), -2.0};
    const GlobalPlan plan = planner.Plan(grid, request);
    if (!std::isfinite(shortest_m)) {
      EXPECT_EQ(plan.outcome, PlanOutcome::kNoConnection);
      continue;
    }
    EXPECT_NEAR(plan.grid_length_m, shortest_m, 1e-3 * shortest_m + 1e-9);
    if (!plan.Found()) {
      // The square is wider than its circle: a finer test must agree that this matters.
      EXPECT_EQ(plan.outcome, PlanOutcome::kTooNarrow);
      const auto wide = DijkstraLengths(grid, footprint.CircumscribedRadius() + 0.1, start);
      EXPECT_FALSE(std::isfinite(wide[CellIndex(grid, goal)]));
      continue;
    }
    if (plan.length_m > 1.15 * shortest_m + 0.1) {
      // Then the shortest way is too narrow to turn, and those that are not are long.
      const auto wide = DijkstraLengths(grid, footprint.CircumscribedRadius() + 0.1, start);
      EXPECT_LE(plan.length_m, 1.15 * wide[CellIndex(grid, goal)] + 0.1);
      EXPECT_GT(wide[CellIndex(grid, goal)], shortest_m + 0.1);
    }
    EXPECT_NEAR(plan.length_m, Length(plan.path), 1e-9);
    ExpectSamePose(plan.path.front(), request.start);
    ExpectSamePose(plan.path.back(), request.goal);
    ExpectDrivable(plan.path, grid, footprint);
  }
}

TEST_P(RandomRooms, TheRobotFits) {
  const ClearanceGrid grid = Clearances(RandomRoom(12.0, 25, 0.05, GetParam()));
  const Footprint footprint;
  const double open_m = footprint.CircumscribedRadius() + 0.06;
  const GlobalPlanner planner({}, footprint);
  int found = 0;
  for (unsigned i = 0; i < 3; ++i) {
    PlanRequest request;
    const Eigen::Vector2i start = OpenCell(grid, open_m, 10 * GetParam() + i);
    const Eigen::Vector2i goal = OpenCell(grid, open_m, 7000 + 10 * GetParam() + i);
    request.start = {grid.CenterOf(start), -0.5};
    request.goal = {grid.CenterOf(goal), 2.5};
    const GlobalPlan plan = planner.Plan(grid, request);
    const auto wide = DijkstraLengths(grid, open_m, start);
    if (std::isfinite(wide[CellIndex(grid, goal)])) {
      EXPECT_TRUE(plan.Found()) << plan.reason;
    }
    if (!plan.Found()) continue;
    ++found;
    EXPECT_LE(plan.length_m, 1.15 * plan.grid_length_m + 0.1);
    ExpectSamePose(plan.path.back(), request.goal);
    ExpectDrivable(plan.path, grid, footprint);
  }
  EXPECT_GT(found, 0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomRooms, testing::Range(1U, 13U));

/// Two rooms of 5 x 6 m, joined by a door in the middle of their wall.
OccupancyGrid TwoRooms(double door_m, double resolution_m) {
  const int width = static_cast<int>(std::lround(10.0 / resolution_m));
  const int height = static_cast<int>(std::lround(6.0 / resolution_m));
  OccupancyGrid cells = EmptyCells(width, height, resolution_m);
  FenceCells(cells);
  FillCells(cells, {4.9, 0.0}, {5.1, 3.0 - 0.5 * door_m});
  FillCells(cells, {4.9, 3.0 + 0.5 * door_m}, {5.1, 6.0});
  return cells;
}

PlanRequest ThroughTheDoor() {
  PlanRequest request;
  request.start = {{1.0, 1.0}, 2.0};
  request.goal = {{9.0, 5.0}, -1.0};
  return request;
}

class Door : public testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(Door, IsFoundWithEverySeed) {
  const auto [door_m, resolution_m] = GetParam();
  const ClearanceGrid grid = Clearances(TwoRooms(door_m, resolution_m));
  GlobalPlannerConfig config;
  for (config.seed = 1; config.seed <= 10; ++config.seed) {
    const GlobalPlan plan = GlobalPlanner(config, Footprint()).Plan(grid, ThroughTheDoor());
    ASSERT_TRUE(plan.Found()) << plan.reason;
    EXPECT_LE(plan.length_m, 1.15 * plan.grid_length_m);
    ExpectDrivable(plan.path, grid, Footprint());
  }
}

INSTANTIATE_TEST_SUITE_P(Widths, Door,
                         testing::Combine(testing::Values(0.8, 0.9), testing::Values(0.05, 0.1)));

TEST(GlobalPlannerTest, KeepsAwayFromWallsWhereThereIsRoom) {
  // A corridor of 2 m with a corner: the shortest way would scrape along it.
  OccupancyGrid cells = EmptyCells(200, 200, 0.05);
  FenceCells(cells);
  FillCells(cells, {2.0, 0.0}, {10.0, 8.0});
  const ClearanceGrid grid = Clearances(cells);
  PlanRequest request;
  request.start = {{1.0, 1.0}, M_PI / 2.0};
  request.goal = {{9.0, 9.0}, 0.0};
  const Footprint footprint;
  const GlobalPlan plan = GlobalPlanner({}, footprint).Plan(grid, request);
  ASSERT_TRUE(plan.Found());
  for (const PlanarPose& pose : plan.path) {
    EXPECT_GT(grid.ClearanceAt(pose.position), footprint.InscribedRadius() + 0.15);
  }
}

TEST(GlobalPlannerTest, IsDeterministic) {
  const ClearanceGrid grid = Clearances(RandomRoom(10.0, 20, 0.05, 4));
  PlanRequest request;
  request.start.position = grid.CenterOf(OpenCell(grid, 0.6, 1));
  request.goal.position = grid.CenterOf(OpenCell(grid, 0.6, 2));
  GlobalPlannerConfig config;
  const GlobalPlan first = GlobalPlanner(config, Footprint()).Plan(grid, request);
  ASSERT_TRUE(first.Found());
  const GlobalPlan second = GlobalPlanner(config, Footprint()).Plan(grid, request);
  ASSERT_EQ(first.path.size(), second.path.size());
  for (std::size_t i = 0; i < first.path.size(); ++i) {
    EXPECT_EQ(first.path[i].position, second.path[i].position);
    EXPECT_EQ(first.path[i].yaw, second.path[i].yaw);
  }
  config.seed = 2;
  EXPECT_NE(GlobalPlanner(config, Footprint()).Plan(grid, request).cost, first.cost);
}

TEST(GlobalPlannerTest, SaysWhyThereIsNoPath) {
  OccupancyGrid cells = TwoRooms(0.8, 0.05);
  FillCells(cells, {8.5, 4.5}, {9.5, 5.5});
  const GlobalPlanner planner({}, Footprint());
  const auto outcome = [&](const OccupancyGrid& map, const PlanRequest& request) {
    const GlobalPlan plan = planner.Plan(Clearances(map), request);
    EXPECT_EQ(plan.reason.empty(), plan.Found());
    EXPECT_EQ(plan.path.empty(), !plan.Found());
    return plan.outcome;
  };
  PlanRequest request = ThroughTheDoor();
  EXPECT_EQ(outcome(cells, request), PlanOutcome::kGoalBlocked);
  EXPECT_EQ(outcome(TwoRooms(0.5, 0.05), request), PlanOutcome::kNoConnection);
  request.goal.position = {30.0, 1.0};
  EXPECT_EQ(outcome(cells, request), PlanOutcome::kGoalOutside);
  request.goal.position = {std::nan(""), 1.0};
  EXPECT_EQ(outcome(cells, request), PlanOutcome::kGoalOutside);
  request = ThroughTheDoor();
  request.start.position = {-3.0, 1.0};
  EXPECT_EQ(outcome(cells, request), PlanOutcome::kStartOutside);
  request.start.position = {5.0, 1.0};
  EXPECT_EQ(outcome(cells, request), PlanOutcome::kStartBlocked);
}

TEST(GlobalPlannerTest, MovesABlockedGoalWithinItsTolerance) {
  OccupancyGrid cells = TwoRooms(0.8, 0.05);
  FillCells(cells, {8.8, 4.8}, {9.2, 5.2});
  const ClearanceGrid grid = Clearances(cells);
  PlanRequest request = ThroughTheDoor();
  request.goal_tolerance_m = 0.8;
  request.yaw_tolerance = 0.3;
  const GlobalPlan plan = GlobalPlanner({}, Footprint()).Plan(grid, request);
  ASSERT_TRUE(plan.Found()) << plan.reason;
  EXPECT_LE((plan.goal.position - request.goal.position).norm(), 0.8);
  EXPECT_LE(std::abs(WrappedAngle(plan.goal.yaw - request.goal.yaw)), 0.3 + 1e-9);
  ExpectDrivable(plan.path, grid, Footprint());
}

TEST(GlobalPlannerTest, GoesNearAGoalThatIsNotFree) {
  OccupancyGrid cells = TwoRooms(0.8, 0.05);
  FillCells(cells, {8.4, 4.4}, {9.6, 5.6});
  const ClearanceGrid grid = Clearances(cells);
  PlanRequest request = ThroughTheDoor();
  request.goal_tolerance_m = 0.3;
  EXPECT_FALSE(GlobalPlanner({}, Footprint()).Plan(grid, request).Found());
  request.approach_m = 1.5;
  const GlobalPlan plan = GlobalPlanner({}, Footprint()).Plan(grid, request);
  ASSERT_TRUE(plan.Found()) << plan.reason;
  EXPECT_TRUE(plan.falls_short);
  EXPECT_LE((plan.goal.position - request.goal.position).norm(), 1.1);
  ExpectDrivable(plan.path, grid, Footprint());
  request.goal.position = {7.5, 4.0};
  EXPECT_FALSE(GlobalPlanner({}, Footprint()).Plan(grid, request).falls_short);
}

TEST(GlobalPlannerTest, ArrivesAsItComesWhenAnyHeadingWillDo) {
  PlanRequest request;
  request.start = {{1.0, 3.0}, 0.0};
  request.goal = {{4.0, 3.0}, M_PI};
  request.yaw_tolerance = M_PI;
  const GlobalPlan plan =
      GlobalPlanner({}, Footprint()).Plan(Clearances(TwoRooms(0.8, 0.05)), request);
  ASSERT_TRUE(plan.Found());
  EXPECT_LT(std::abs(WrappedAngle(plan.path.back().yaw)), 0.7);
}

TEST(GlobalPlannerTest, LeavesAPlaceThatIsSlightlyTooTight) {
  const ClearanceGrid grid = Clearances(TwoRooms(0.8, 0.05));
  const Footprint footprint;
  PlanRequest request = ThroughTheDoor();
  // Beside the wall at y = 0.05, within the margin.
  request.start = {{2.0, 0.05 + footprint.half_width_m + 0.005}, 0.0};
  ASSERT_TRUE(footprint.Collides(grid, request.start));
  const GlobalPlan plan = GlobalPlanner({}, footprint).Plan(grid, request);
  ASSERT_TRUE(plan.Found()) << plan.reason;
  Footprint bare = footprint;
  bare.margin_m = -GlobalPlannerConfig().start_slack_m;
  EXPECT_FALSE(FirstCollision(plan.path, grid, bare, 0, 1e9));
}

TEST(GlobalPlannerTest, TurnsWhereItFitsOnly) {
  // A corridor of 0.75 m, in which the robot cannot turn, between two rooms; it enters straight.
  OccupancyGrid cells = EmptyCells(240, 80, 0.05);
  FenceCells(cells);
  FillCells(cells, {4.0, 0.0}, {8.0, 1.62});
  FillCells(cells, {4.0, 2.38}, {8.0, 4.0});
  const ClearanceGrid grid = Clearances(cells);
  PlanRequest request;
  request.start = {{1.0, 1.0}, -2.0};
  request.goal = {{11.0, 3.0}, 2.0};
  const GlobalPlan plan = GlobalPlanner({}, Footprint()).Plan(grid, request);
  ASSERT_TRUE(plan.Found()) << plan.reason;
  ExpectDrivable(plan.path, grid, Footprint());
  // Looking back in the corridor, it must have turned in the other room.
  request.goal = {{6.0, 2.0}, M_PI};
  EXPECT_TRUE(GlobalPlanner({}, Footprint()).Plan(grid, request).Found());
  FillCells(cells, {8.0, 0.0}, {12.0, 4.0});
  EXPECT_EQ(GlobalPlanner({}, Footprint()).Plan(Clearances(cells), request).outcome,
            PlanOutcome::kTooNarrow);
}

TEST(GlobalPlannerTest, TellsThatTheRobotIsCornered) {
  OccupancyGrid cells = EmptyCells(120, 60, 0.1);
  FenceCells(cells);
  FillCells(cells, {8.0, 0.0}, {12.0, 2.6});
  FillCells(cells, {8.0, 3.4}, {12.0, 6.0});
  PlanRequest request;
  request.start = {{10.5, 3.0}, 0.0};
  request.goal = {{2.0, 3.0}, 0.0};
  const GlobalPlanner planner({}, Footprint());
  EXPECT_EQ(planner.Plan(Clearances(cells), request).outcome, PlanOutcome::kCornered);
  request.start.yaw = M_PI;
  EXPECT_TRUE(planner.Plan(Clearances(cells), request).Found());
}

TEST(GlobalPlannerTest, GoesAroundWhereTheShortestWayIsTooNarrowToTurn) {
  OccupancyGrid cells = EmptyCells(100, 100, 0.1);
  FenceCells(cells);
  // An alley of 0.7 m between two walls: a circle gets through, the robot cannot turn in it.
  FillCells(cells, {4.0, 0.0}, {4.1, 10.0});
  FillCells(cells, {4.8, 0.0}, {4.9, 10.0});
  FillCells(cells, {4.0, 2.0}, {4.1, 2.7}, OccupancyGrid::kFree);
  FillCells(cells, {4.8, 3.0}, {4.9, 3.7}, OccupancyGrid::kFree);
  PlanRequest request;
  request.start = {{2.0, 2.4}, 0.0};
  request.goal = {{7.0, 3.4}, 0.0};
  const GlobalPlanner planner({}, Footprint());
  EXPECT_EQ(planner.Plan(Clearances(cells), request).outcome, PlanOutcome::kTooNarrow);
  FillCells(cells, {4.0, 7.0}, {4.9, 8.5}, OccupancyGrid::kFree);
  const ClearanceGrid grid = Clearances(cells);
  const GlobalPlan plan = planner.Plan(grid, request);
  ASSERT_TRUE(plan.Found()) << plan.reason;
  ExpectDrivable(plan.path, grid, Footprint());
  EXPECT_GT(plan.length_m, 11.0);
}

TEST(GlobalPlannerTest, TakesTheDoorThatItFitsThrough) {
  // Between two halls: an alley of 0.7 m to be entered and left aside, through which a circle gets,
  // and far away a door of 0.8 m in line, in which the robot cannot turn either.
  OccupancyGrid cells = EmptyCells(400, 400, 0.1);
  FenceCells(cells);
  FillCells(cells, {20.0, 0.0}, {20.1, 40.0});
  FillCells(cells, {20.8, 0.0}, {20.9, 40.0});
  FillCells(cells, {20.0, 2.0}, {20.1, 2.7}, OccupancyGrid::kFree);
  FillCells(cells, {20.8, 3.0}, {20.9, 3.7}, OccupancyGrid::kFree);
  FillCells(cells, {20.0, 30.0}, {20.9, 30.8}, OccupancyGrid::kFree);
  const ClearanceGrid grid = Clearances(cells);
  PlanRequest request;
  request.start = {{18.0, 2.4}, 0.0};
  request.goal = {{23.0, 2.4}, 0.0};
  const GlobalPlan plan = GlobalPlanner({}, Footprint()).Plan(grid, request);
  ASSERT_TRUE(plan.Found()) << plan.reason;
  EXPECT_LT(plan.grid_length_m, 10.0);
  EXPECT_GT(plan.length_m, 50.0);
  ExpectDrivable(plan.path, grid, Footprint());
}

TEST(GlobalPlannerTest, MovesAGoalToWhereTheRobotCanJustTurn) {
  // A blind alley, 1.1 m wide: the robot can turn in its middle only.
  OccupancyGrid cells = EmptyCells(60, 13, 0.1);
  FenceCells(cells);
  const ClearanceGrid grid = Clearances(cells);
  PlanRequest request;
  request.start = {{1.0, 0.65}, 0.0};
  request.goal = {{5.3, 0.75}, M_PI - 0.5};
  request.goal_tolerance_m = 0.3;
  request.yaw_tolerance = 0.1;
  const GlobalPlan plan = GlobalPlanner({}, Footprint()).Plan(grid, request);
  ASSERT_TRUE(plan.Found()) << plan.reason;
  ExpectDrivable(plan.path, grid, Footprint());
  EXPECT_LT((plan.goal.position - request.goal.position).norm(), 0.3);
}

}  // namespace
}  // namespace hv::navigation
