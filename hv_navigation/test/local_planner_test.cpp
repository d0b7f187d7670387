#include "hv_navigation/local_planner.h"

#include <cmath>

#include <gtest/gtest.h>

#include "grids.h"
#include "hv_navigation/global_planner.h"
#include "kinematic_robot.h"

namespace hv::navigation {
namespace {

ClearanceGrid LocalClearances(const OccupancyGrid& cells) {
  return ClearanceGrid(cells, ClearanceGrid::Unknown::kOccupied, 2.0);
}

OccupancyGrid Hall() {
  OccupancyGrid cells = EmptyCells(200, 100, 0.05);
  FenceCells(cells);
  return cells;
}

Path StraightPath(const PlanarPose& from, double length_m) {
  Path path;
  for (int i = 0; i <= static_cast<int>(10.0 * length_m); ++i) {
    path.push_back(from * PlanarPose{{0.1 * i, 0.0}, 0.0});
  }
  return path;
}

/// A robot under the control of a local planner.
struct Follower {
  explicit Follower(const PlanarPose& start)
      : planner({}, limits, footprint), robot(start, limits) {}

  const LocalPlan& Step(const ObstaclesAhead& ahead) {
    const Velocity before = robot.velocity();
    plan = planner.Plan(ahead, robot.pose(), before);
    const Velocity next = plan.velocity.value_or(planner.Brake(before, before));
    ExpectWithinLimits(before, next);
    robot.Drive(next, config.period_s);
    collided |= Bare(footprint).Collides(ahead.grid, robot.pose());
    return plan;
  }

  /// Until the plan has `state`; the time it took [s].
  double Until(LocalState state, const ClearanceGrid& grid, double longest_s) {
    double time_s = 0.0;
    do {
      time_s += config.period_s;
    } while (Step(grid).state != state && time_s < longest_s);
    return time_s;
  }

  void ExpectWithinLimits(const Velocity& from, const Velocity& to) const {
    constexpr double kRounding = 1e-9;
    EXPECT_LE(std::abs(to.linear_mps), limits.max_linear_mps + kRounding);
    EXPECT_LE(std::abs(to.angular_rps), limits.max_angular_rps + kRounding);
    EXPECT_LE(to.linear_mps - from.linear_mps,
              limits.linear_acceleration_mps2 * config.period_s + kRounding);
    EXPECT_LE(from.linear_mps - to.linear_mps,
              limits.linear_braking_mps2 * config.period_s + kRounding);
    EXPECT_LE(std::abs(to.angular_rps - from.angular_rps),
              limits.angular_acceleration_rps2 * config.period_s + kRounding);
  }

  LocalPlannerConfig config;
  MotionLimits limits;
  Footprint footprint;
  LocalPlanner planner;
  KinematicRobot robot;
  LocalPlan plan;
  bool collided = false;
};

class ClutteredRoom : public testing::TestWithParam<unsigned> {};

TEST_P(ClutteredRoom, ReachesGoalsWithoutCollision) {
  const ClearanceGrid grid = LocalClearances(RandomRoom(10.0, 18, 0.05, GetParam()));
  const Footprint footprint;
  const double open_m = footprint.CircumscribedRadius() + 0.06;
  const auto pose = [&](unsigned seed) {
    return PlanarPose{grid.CenterOf(OpenCell(grid, open_m, seed)), 0.7 * seed};
  };
  Follower run(pose(GetParam()));
  int goals = 0;
  for (unsigned i = 1; goals < 5 && i < 50; ++i) {
    PlanRequest request;
    request.start = run.robot.pose();
    request.goal = pose(100 * GetParam() + i);
    const GlobalPlan plan = GlobalPlanner({}, footprint).Plan(grid, request);
    if (!plan.Found()) continue;
    ++goals;
    run.planner.SetPath(plan.path);
    const double driven_m = run.robot.driven_m();
    run.Until(LocalState::kReached, grid, 20.0 + 6.0 * plan.length_m);
    ASSERT_EQ(run.plan.state, LocalState::kReached)
        << "goal " << i << ", " << run.plan.reason << ", left " << run.plan.remaining_m << ", at "
        << run.robot.pose().position.transpose() << " " << run.robot.pose().yaw;
    EXPECT_LE((run.robot.pose().position - request.goal.position).norm(), 0.1);
    EXPECT_LE(std::abs(WrappedAngle(run.robot.pose().yaw - request.goal.yaw)), 0.1);
    EXPECT_LT(run.robot.driven_m() - driven_m, 1.15 * plan.length_m + 0.5);
    ASSERT_FALSE(run.collided);
  }
  EXPECT_EQ(goals, 5);
}

INSTANTIATE_TEST_SUITE_P(Seeds, ClutteredRoom, testing::Range(1U, 21U));

TEST(LocalPlannerTest, IsFastWhereThereIsRoom) {
  const ClearanceGrid grid = LocalClearances(Hall());
  Follower run({{1.0, 2.5}, 0.0});
  run.planner.SetPath(StraightPath(run.robot.pose(), 8.0));
  const double time_s = run.Until(LocalState::kReached, grid, 60.0);
  EXPECT_EQ(run.plan.state, LocalState::kReached);
  EXPECT_LT(time_s, 13.0);
}

TEST(LocalPlannerTest, TurnsOnTheSpotWhenThePathBeginsBehind) {
  const ClearanceGrid grid = LocalClearances(Hall());
  Follower run({{5.0, 2.5}, M_PI});
  run.planner.SetPath(StraightPath({{5.0, 2.5}, 0.0}, 3.0));
  while (std::abs(WrappedAngle(run.robot.pose().yaw)) > 0.9) {
    ASSERT_EQ(run.Step(grid).state, LocalState::kDriving);
    ASSERT_LT((run.robot.pose().position - Eigen::Vector2d(5.0, 2.5)).norm(), 0.02);
  }
  run.Until(LocalState::kReached, grid, 20.0);
  EXPECT_EQ(run.plan.state, LocalState::kReached);
}

/// A person fills the hall from wall to wall, so that there is no way round.
OccupancyGrid HallWithPerson(double x) {
  OccupancyGrid cells = Hall();
  FillCells(cells, {x, 0.0}, {x + 0.4, 5.0});
  return cells;
}

TEST(LocalPlannerTest, StopsBeforeWhatAppearsAndGoesOnAfterwards) {
  const ClearanceGrid empty = LocalClearances(Hall());
  for (double gap_m = 1.1; gap_m < 3.0; gap_m += 0.15) {
    Follower run({{1.0, 2.5}, 0.0});
    run.planner.SetPath(StraightPath(run.robot.pose(), 8.0));
    while (run.robot.pose().position.x() < 3.0) run.Step(empty);
    ASSERT_GT(run.robot.velocity().linear_mps, 0.9);
    const ClearanceGrid blocked = LocalClearances(HallWithPerson(3.0 + gap_m));
    run.Until(LocalState::kBlocked, blocked, 10.0);
    EXPECT_EQ(run.plan.state, LocalState::kBlocked);
    for (int i = 0; i < 30; ++i) run.Step(blocked);
    EXPECT_EQ(run.plan.state, LocalState::kBlocked);
    EXPECT_FALSE(run.plan.reason.empty());
    EXPECT_NEAR(run.robot.velocity().linear_mps, 0.0, 1e-6);
    EXPECT_FALSE(run.collided) << gap_m;
    run.Until(LocalState::kReached, empty, 30.0);
    EXPECT_EQ(run.plan.state, LocalState::kReached);
  }
}

TEST(LocalPlannerTest, LetsAPersonCross) {
  // At 1 m/s, into the way of the robot when it is 1 to 1.6 m away.
  for (const double begin_s : {0.0, 0.25, 0.5}) {
    Follower run({{1.0, 2.5}, 0.0});
    run.planner.SetPath(StraightPath(run.robot.pose(), 8.0));
    double slowest_mps = 1.0;
    double time_s = 0.0;
    for (; time_s < 40.0 && run.plan.state != LocalState::kReached; time_s += 0.1) {
      OccupancyGrid cells = Hall();
      const double y = std::min(4.5, 0.2 + std::max(0.0, time_s - begin_s));
      FillCells(cells, {4.0, y - 0.2}, {4.4, y + 0.2});
      run.Step(LocalClearances(cells));
      const bool near = run.robot.pose().position.x() > 2.5 && run.robot.pose().position.x() < 4.0;
      if (near) slowest_mps = std::min(slowest_mps, run.robot.velocity().linear_mps);
    }
    EXPECT_EQ(run.plan.state, LocalState::kReached);
    EXPECT_FALSE(run.collided) << begin_s;
    EXPECT_LT(slowest_mps, 0.9);
    EXPECT_LT(time_s, 20.0);
  }
}

/// The hall and one person in it, who is noticed all along.
struct PersonInHall {
  Eigen::Vector2d from;
  Eigen::Vector2d velocity;
  double turns_s = 1e9;  ///< walks on with `then` from this time on
  Eigen::Vector2d then = Eigen::Vector2d::Zero();
  double lag_s = 0.0;  ///< by which the person is noticed too late

  Eigen::Vector2d At(double time_s) const {
    return from + std::min(time_s, turns_s) * velocity + std::max(0.0, time_s - turns_s) * then;
  }
  Walker NoticedAt(double time_s, Time stamp) const {
    const Eigen::Vector2d way = At(time_s - lag_s) - At(time_s - lag_s - 0.3);
    return {stamp, At(time_s - lag_s), way.normalized()};
  }
  double DistanceTo(const PlanarPose& robot, const Footprint& footprint, double time_s) const {
    const Eigen::Vector2d there = robot.Inverse() * At(time_s);
    const Eigen::Vector2d most(footprint.front_m, footprint.half_width_m);
    const Eigen::Vector2d least(-footprint.back_m, -footprint.half_width_m);
    return (there - there.cwiseMax(least).cwiseMin(most)).norm();
  }
};

struct Encounter {
  LocalState state;
  double time_s;
  double nearest_moving_m;  ///< between the person's middle and the robot, while it moves
  double slowest_mps;       ///< after the first second, before the goal
};

/// The robot drives 8 m along the hall.
Encounter Meet(const PersonInHall& person) {
  Follower run({{1.0, 2.5}, 0.0});
  run.planner.SetPath(StraightPath(run.robot.pose(), 8.0));
  Encounter result{LocalState::kDriving, 0.0, 100.0, 1.0};
  const WalkConfig walk;
  for (; result.time_s < 40.0 && run.plan.state != LocalState::kReached; result.time_s += 0.1) {
    const Eigen::Vector2d at = person.At(result.time_s);
    OccupancyGrid cells = Hall();
    FillCells(cells, at - Eigen::Vector2d(0.2, 0.2), at + Eigen::Vector2d(0.2, 0.2));
    const ClearanceGrid grid = LocalClearances(cells);
    const Time now = Time::FromSeconds(100.0 + result.time_s);
    const Walkers walkers(walk, {person.NoticedAt(result.time_s, now)});
    run.Step({grid, &walkers, now});
    const Velocity& velocity = run.robot.velocity();
    if (std::abs(velocity.linear_mps) > 0.02 || std::abs(velocity.angular_rps) > 0.05) {
      const double distance_m =
          person.DistanceTo(run.robot.pose(), run.footprint, result.time_s + 0.1);
      result.nearest_moving_m = std::min(result.nearest_moving_m, distance_m);
    }
    if (result.time_s > 2.0 && run.plan.remaining_m > 1.0) {
      result.slowest_mps = std::min(result.slowest_mps, velocity.linear_mps);
    }
  }
  result.state = run.plan.state;
  return result;
}

TEST(LocalPlannerTest, MovesIntoNobodyWhoWalks) {
  for (const double speed_mps : {0.8, 1.2}) {
    for (double begin_m = 0.3; begin_m < 4.7; begin_m += 0.8) {
      for (const double side : {-1.0, 1.0}) {
        // Across the hall, and out through its wall.
        const Encounter across =
            Meet({{4.0, 2.5 - side * (2.5 + begin_m)}, {0.0, side * speed_mps}});
        EXPECT_EQ(across.state, LocalState::kReached) << begin_m;
        EXPECT_GT(across.nearest_moving_m, 0.2) << begin_m << " " << side << " " << speed_mps;
      }
      const Encounter towards = Meet({{3.0 + begin_m, 2.5}, {-speed_mps, 0.0}});
      EXPECT_GT(towards.nearest_moving_m, 0.2) << begin_m << " " << speed_mps;
    }
  }
}

TEST(LocalPlannerTest, MovesIntoNobodyWhoTurnsTowardsIt) {
  // Across the hall, ahead of the robot, and then straight at it; seen a little late.
  const double speed_mps = 1.3;
  for (double turns_s = 0.4; turns_s < 4.0; turns_s += 0.4) {
    for (const double beside_m : {-0.1, 0.2}) {
      const PersonInHall person{{4.5, 2.5 + beside_m - speed_mps * turns_s},
                                {0.0, speed_mps},
                                turns_s,
                                {-speed_mps, 0.0},
                                0.2};
      EXPECT_GT(Meet(person).nearest_moving_m, 0.3) << turns_s << " " << beside_m;
    }
  }
}

TEST(LocalPlannerTest, GoesOnWhenSomebodyWalksAway) {
  // Away across the hall, just off the path, and ahead of the robot as fast as it drives.
  EXPECT_GT(Meet({{4.0, 3.6}, {0.0, 1.0}}).slowest_mps, 0.6);
  EXPECT_GT(Meet({{3.5, 2.5}, {1.2, 0.0}}).slowest_mps, 0.6);
  // Slower beside somebody who comes the other way, and might turn.
  EXPECT_GT(Meet({{8.0, 3.7}, {-1.0, 0.0}}).slowest_mps, 0.1);
  EXPECT_LT(Meet({{8.0, 3.7}, {-1.0, 0.0}}).slowest_mps, 0.6);
}

TEST(LocalPlannerTest, WhoStandsLetsThoseNearbyGoFirst) {
  const ClearanceGrid grid = LocalClearances(Hall());
  const Time now = Time::FromSeconds(100.0);
  const PlanarPose pose{{3.0, 2.5}, 0.0};
  // One metre beside the robot, and walking away from it.
  const Walkers walkers({}, {{now, {3.0, 3.78}, {0.0, 1.0}}});
  LocalPlanner planner({}, {}, Footprint());
  planner.SetPath(StraightPath(pose, 5.0));
  EXPECT_EQ(planner.Plan({grid, &walkers, now}, pose, {}).state, LocalState::kBlocked);
  EXPECT_EQ(planner.Plan({grid, &walkers, now}, pose, {0.2, 0.0}).state, LocalState::kDriving);
  EXPECT_EQ(planner.Plan(grid, pose, {}).state, LocalState::kDriving);
}

TEST(LocalPlannerTest, PassesANarrowDoor) {
  OccupancyGrid cells = Hall();
  FillCells(cells, {4.9, 0.0}, {5.1, 2.1});
  FillCells(cells, {4.9, 2.9}, {5.1, 5.0});
  const ClearanceGrid grid = LocalClearances(cells);
  PlanRequest request;
  request.start = {{2.0, 1.0}, 2.0};
  request.goal = {{8.0, 1.0}, 0.0};
  const GlobalPlan plan = GlobalPlanner({}, Footprint()).Plan(grid, request);
  ASSERT_TRUE(plan.Found());
  Follower run(request.start);
  run.planner.SetPath(plan.path);
  run.Until(LocalState::kReached, grid, 60.0);
  EXPECT_EQ(run.plan.state, LocalState::kReached) << run.plan.reason;
  EXPECT_FALSE(run.collided);
}

TEST(LocalPlannerTest, CreepsNoNearerToWhatItStandsTooNearTo) {
  OccupancyGrid cells = Hall();
  FillCells(cells, {5.0, 0.0}, {5.2, 5.0});
  const ClearanceGrid grid = LocalClearances(cells);
  const PlanarPose start{{5.0 - Footprint().front_m - 0.015, 2.5}, 0.0};
  Follower follower(start);
  follower.planner.SetPath(StraightPath(start, 2.0));
  for (int i = 0; i < 100; ++i) follower.Step(grid);
  EXPECT_LT(follower.robot.pose().position.x(), start.position.x() + 0.012);
  EXPECT_FALSE(follower.collided);
  const auto back = follower.planner.BackOff(grid, follower.robot.pose(), Velocity());
  ASSERT_TRUE(back);
  EXPECT_LT(back->linear_mps, 0.0);
}

TEST(LocalPlannerTest, GoesOnAlongAWallThatItStandsTooNearTo) {
  OccupancyGrid cells = Hall();
  FillCells(cells, {0.0, 3.0}, {10.0, 3.2});
  const ClearanceGrid grid = LocalClearances(cells);
  const PlanarPose start{{2.0, 3.0 - Footprint().half_width_m - 0.015}, 0.0};
  Follower follower(start);
  follower.planner.SetPath(StraightPath(start, 3.0));
  follower.Until(LocalState::kReached, grid, 30.0);
  EXPECT_EQ(follower.plan.state, LocalState::kReached);
  EXPECT_FALSE(follower.collided);
}

/// A turn swings its tail to the wall: it must drive away first, or turn the other way.
TEST(LocalPlannerTest, TurnsAwayFromAWallWithoutTouchingIt) {
  OccupancyGrid cells = Hall();
  FillCells(cells, {0.0, 4.0}, {10.0, 4.2});
  const ClearanceGrid grid = LocalClearances(cells);
  const Footprint body;
  for (const double yaw : {-0.1, -0.2, -0.3, -0.5}) {
    const double reach_m = body.back_m * std::sin(-yaw) + body.half_width_m * std::cos(yaw);
    const PlanarPose start{{2.0, 4.0 - reach_m - 0.01}, yaw};
    Follower follower(start);
    follower.planner.SetPath(StraightPath({start.position, -1.3}, 2.0));
    follower.Until(LocalState::kReached, grid, 60.0);
    EXPECT_EQ(follower.plan.state, LocalState::kReached) << yaw << ": " << follower.plan.reason;
    EXPECT_FALSE(follower.collided) << yaw;
  }
}

TEST(LocalPlannerTest, StandsWithoutAPathAndInObstacles) {
  const ClearanceGrid grid = LocalClearances(HallWithPerson(2.0));
  LocalPlanner planner({}, {}, Footprint());
  const Velocity moving{0.5, 0.2};
  LocalPlan plan = planner.Plan(grid, {{5.0, 2.5}, 0.0}, moving);
  EXPECT_EQ(plan.state, LocalState::kNoPath);
  EXPECT_FALSE(plan.velocity);
  const Velocity braked = planner.Brake(moving, moving);
  EXPECT_LT(braked.linear_mps, 0.5);
  EXPECT_NEAR(braked.angular_rps / braked.linear_mps, 0.4, 1e-9);
  planner.SetPath(StraightPath({{2.2, 2.5}, 0.0}, 5.0));
  plan = planner.Plan(grid, {{2.2, 2.5}, 0.0}, {});
  EXPECT_EQ(plan.state, LocalState::kBlocked);
  EXPECT_FALSE(plan.velocity);
  EXPECT_FALSE(plan.reason.empty());
}

}  // namespace
}  // namespace hv::navigation
