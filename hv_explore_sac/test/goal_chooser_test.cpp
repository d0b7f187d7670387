#include "hv_explore_sac/goal_chooser.h"

#include <functional>

#include <gtest/gtest.h>

#include "toy_building.h"

namespace hv::explore {
namespace {

std::unique_ptr<Planner> Utility(const PlannerInputs& inputs) {
  return MakePlanner("utility", inputs);
}

GoalChooser Chooser(const ExplorerConfig& config = {}, const Bounds& bounds = {}) {
  return GoalChooser(config, kRobotSize, bounds, Utility);
}

ExplorerConfig OnlyGates() {
  ExplorerConfig config;
  config.places.only_gates = true;
  return config;
}

bool VisitedAt(const GoalChooser& chooser, const Eigen::Vector2d& position) {
  const ViewpointGraph& graph = chooser.model()->graph();
  const int viewpoint = graph.At(chooser.frame().CellOf(position));
  return viewpoint >= 0 && graph.Visited(viewpoint);
}

TEST(GoalChooserTest, ChoosesViewpointsThatTheRobotCanReach) {
  const ToyRobot robot(TwoRooms(), {6.0, 1.2});
  GoalChooser chooser = Chooser();
  ASSERT_EQ(chooser.Look(robot.known(), robot.pose().position), Outlook::kGoals);
  const ViewpointGoal goal = chooser.Choose(true);
  EXPECT_GE(goal.utility, ExplorerConfig().places.min_utility);
  EXPECT_TRUE(ToyRobot(robot).CanReach(goal.pose.position));
  EXPECT_TRUE(chooser.IsWorth(goal));
  const std::vector<Eigen::Vector2d> way = chooser.WayTo(goal);
  ASSERT_GE(way.size(), 2U);
  EXPECT_LT((way.front() - robot.pose().position).norm(), 0.15);
  EXPECT_EQ(way.back(), goal.pose.position);
  const Eigen::Vector2d last = way.back() - way[way.size() - 2];
  EXPECT_NEAR(goal.pose.yaw, std::atan2(last.y(), last.x()), 1e-6);
}

TEST(GoalChooserTest, WhatWasVisitedStaysSoWhenTheMapGrows) {
  ToyRobot robot(TwoRooms(), {2.5, 1.2});
  GoalChooser chooser = Chooser();
  chooser.NoteStood(robot.pose().position);
  chooser.Look(robot.known(), robot.pose().position);
  const Eigen::Vector2i cell = chooser.frame().CellOf(robot.pose().position);
  const Eigen::Vector2i low = chooser.model()->belief().low();
  ASSERT_TRUE(VisitedAt(chooser, {2.5, 1.2}));
  robot.DriveTowards({10.5, 1.2}, 20.0);
  ASSERT_EQ(chooser.Look(robot.known(), robot.pose().position), Outlook::kGoals);
  EXPECT_NE(chooser.model()->belief().low(), low);
  EXPECT_EQ(chooser.frame().CellOf({2.5, 1.2}), cell);
  EXPECT_TRUE(VisitedAt(chooser, {2.5, 1.2}));
}

TEST(GoalChooserTest, NodesNearWhereItStoodCountAsVisited) {
  const ToyRobot robot(TwoRooms(), {6.0, 1.2});
  GoalChooser chooser = Chooser();
  chooser.NoteStood({6.0, 1.2});
  chooser.Look(robot.known(), robot.pose().position);
  const ViewpointGraph& graph = chooser.model()->graph();
  int visited = 0;
  for (int viewpoint = 0; viewpoint < graph.size(); ++viewpoint) {
    const double distance_m =
        (chooser.frame().CenterOf(graph.CellOf(viewpoint)) - Eigen::Vector2d(6.0, 1.2)).norm();
    if (distance_m > 0.7) {
      EXPECT_FALSE(graph.Visited(viewpoint));
    }
    if (distance_m < 0.4) {
      EXPECT_TRUE(graph.Visited(viewpoint));
    }
    visited += graph.Visited(viewpoint);
  }
  EXPECT_GE(visited, 1);
}

TEST(GoalChooserTest, RefusedGoalsAreLeftAloneUntilTheyExpire) {
  ExplorerConfig config;
  config.goals.refused_for_s = 4.0;  // of decisions, one a second
  const ToyRobot robot(TwoRooms(), {6.0, 1.2});
  GoalChooser chooser = Chooser(config);
  ASSERT_EQ(chooser.Look(robot.known(), robot.pose().position), Outlook::kGoals);
  const ViewpointGoal refused = chooser.Choose(false);
  chooser.Refuse(refused);
  for (int decision = 1; decision <= 6; ++decision) {
    ASSERT_EQ(chooser.Look(robot.known(), robot.pose().position), Outlook::kGoals);
    EXPECT_EQ(chooser.IsWorth(refused), decision > 4) << decision;
    if (decision <= 4) {
      EXPECT_NE(chooser.Choose(false).cell, refused.cell);
    }
  }
}

TEST(GoalChooserTest, TellsWhyThereIsNoGoal) {
  const OccupancyGrid truth = TwoRooms();
  GoalChooser all = Chooser();
  EXPECT_EQ(all.Look(truth, {6.0, 1.2}), Outlook::kNothing);
  EXPECT_EQ(all.Look(truth, {100.0, 1.2}), Outlook::kNoFreePlace);
  // The left room is unknown but for a part that no way leads to.
  OccupancyGrid part = truth;
  for (int y = 25; y < 75; ++y) {
    for (int x = 5; x < 50; ++x) {
      if (x < 15 || x > 35 || y < 35) part.At(x, y) = OccupancyGrid::kUnknown;
    }
  }
  for (int y = 20; y < 30; ++y) {
    for (int x = 5; x < 55; ++x) part.At(x, y) = OccupancyGrid::kOccupied;
  }
  EXPECT_EQ(Chooser().Look(part, {6.0, 1.2}), Outlook::kUnreached);
  EXPECT_EQ(Chooser(OnlyGates()).Look(part, {6.0, 1.2}), Outlook::kNothing);
}

/// The left room as far as it is seen through its door, the rest of which `close` takes away.
OccupancyGrid SeenThroughDoor(const std::function<void(OccupancyGrid&)>& close) {
  OccupancyGrid map = TwoRooms();
  close(map);
  for (int y = 50; y < 75; ++y) {
    for (int x = 5; x < 50; ++x) map.At(x, y) = OccupancyGrid::kUnknown;
  }
  return map;
}

TEST(GoalChooserTest, WithOnlyGatesRoomsThatItCannotEnterNeedNotBeSeen) {
  const Eigen::Vector2d corridor(2.0, 1.2);
  const OccupancyGrid wide = SeenThroughDoor([](OccupancyGrid&) {});
  EXPECT_EQ(Chooser(OnlyGates()).Look(wide, corridor), Outlook::kGoals);
  // Half of the door is 0.5 m wide, the robot 0.56 m.
  const OccupancyGrid narrow = SeenThroughDoor([](OccupancyGrid& map) {
    for (int y = 20; y < 25; ++y) {
      for (int x = 20; x < 25; ++x) map.At(x, y) = OccupancyGrid::kOccupied;
    }
  });
  EXPECT_EQ(Chooser(OnlyGates()).Look(narrow, corridor), Outlook::kNothing);
  EXPECT_EQ(Chooser().Look(narrow, corridor), Outlook::kGoals);
}

TEST(GoalChooserTest, ARoomThatItHasEnteredIsNoTrap) {
  // It has come through half of the door; the end of the corridor is unknown.
  OccupancyGrid map = TwoRooms();
  for (int y = 20; y < 25; ++y) {
    for (int x = 20; x < 25; ++x) map.At(x, y) = OccupancyGrid::kOccupied;
  }
  for (int y = 5; y < 20; ++y) {
    for (int x = 80; x < 115; ++x) map.At(x, y) = OccupancyGrid::kUnknown;
  }
  const Eigen::Vector2d inside(2.75, 3.5);
  EXPECT_EQ(Chooser(OnlyGates()).Look(map, inside), Outlook::kNothing);
  GoalChooser chooser = Chooser(OnlyGates());
  for (const double y : {1.2, 2.0, 2.8}) chooser.NoteStood({2.75, y});
  ASSERT_EQ(chooser.Look(map, inside), Outlook::kGoals);
  EXPECT_GT(chooser.Choose(true).pose.position.x(), 4.0);
}

TEST(GoalChooserTest, GoalsThatWereRefusedAreNotTheSameAsNone) {
  ExplorerConfig config;
  config.goals.refused_radius_m = 50.0;
  const ToyRobot robot(TwoRooms(), {6.0, 1.2});
  GoalChooser chooser = Chooser(config);
  ASSERT_EQ(chooser.Look(robot.known(), robot.pose().position), Outlook::kGoals);
  chooser.Refuse(chooser.Choose(false));
  EXPECT_EQ(chooser.Look(robot.known(), robot.pose().position), Outlook::kRefused);
  chooser.ForgetRefusals();
  EXPECT_EQ(chooser.Look(robot.known(), robot.pose().position), Outlook::kGoals);
}

TEST(GoalChooserTest, StaysInsideOfTheBounds) {
  const Bounds bounds({{0.0, 0.0}, {6.0, 0.0}, {6.0, 8.0}, {0.0, 8.0}});
  const ToyRobot robot(TwoRooms(), {3.0, 1.2});
  GoalChooser chooser = Chooser({}, bounds);
  ASSERT_EQ(chooser.Look(robot.known(), robot.pose().position), Outlook::kGoals);
  const ExplorationModel& model = *chooser.model();
  for (int viewpoint = 0; viewpoint < model.graph().size(); ++viewpoint) {
    EXPECT_TRUE(bounds.Contains(chooser.frame().CenterOf(model.graph().CellOf(viewpoint))));
  }
  for (const int point : model.frontiers().points()) {
    EXPECT_LT(chooser.frame().CenterOf(model.frontiers().CellOf(point)).x(), 6.0);
  }
  EXPECT_LT(chooser.free_m2(), FreeArea(robot.known(), {}));
}

TEST(GoalChooserTest, AMapThatWasForgottenIsExploredAnew) {
  const ToyRobot first(TwoRooms(), {6.0, 1.2});
  GoalChooser chooser = Chooser();
  chooser.NoteStood({6.0, 1.2});
  chooser.Look(TwoRooms(), {6.0, 1.2});
  ASSERT_TRUE(VisitedAt(chooser, {6.0, 1.2}));
  chooser.Look(first.known(), {1.0, 1.2});
  EXPECT_FALSE(VisitedAt(chooser, {6.0, 1.2}));
}

TEST(GoalChooserTest, PrefersViewpointsWhereTheRobotCanTurn) {
  const ToyRobot robot(TwoRooms(), {6.0, 1.2});
  GoalChooser roomy = Chooser();
  ASSERT_EQ(roomy.Look(robot.known(), robot.pose().position), Outlook::kGoals);
  for (const Observation::Node& node : roomy.observation().nodes) {
    const Eigen::Vector2i& cell = roomy.model()->graph().CellOf(node.viewpoint);
    if (node.utility > 0) {
      EXPECT_TRUE(roomy.CanTurnAt(roomy.frame().CenterOf(cell)));
    }
  }
  EXPECT_TRUE(roomy.CanTurnAt({6.0, 1.2}));
  EXPECT_FALSE(roomy.CanTurnAt({6.0, 0.8}));
  // One that can turn nowhere takes what there is.
  const RobotSize large{kRobotRadius_m, 3.0};
  GoalChooser narrow(ExplorerConfig(), large, Bounds(), Utility);
  EXPECT_EQ(narrow.Look(robot.known(), robot.pose().position), Outlook::kGoals);
}

}  // namespace
}  // namespace hv::explore
