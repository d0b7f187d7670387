#include "hv_sim/motion.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "hv_core/error.h"
#include "hv_core/so3.h"
#include "hv_sim/lidar.h"

namespace hv::sim {
namespace {

using Eigen::Vector3d;

/// A closed way with level corners, a ramp and a dead end.
World MotionLoop() {
  World world;
  world.name = "loop";
  world.route = {{0, 0, 0}, {8, 0, 0},    {8, 6, 0},    {14, 6, 0},
                 {8, 6, 0}, {8, 16, 1.5}, {0, 16, 1.5}, {0, 4, 0}};
  return world;
}

World MotionHall() {
  World world;
  world.name = "hall";
  world.route = {{0, 0, 0}, {12, 0, 0}, {16, 4, 0}};
  world.closed = false;
  return world;
}

MotionConfig Config(const std::string& style, double duration_s) {
  MotionConfig config;
  config.style = style;
  config.duration_s = duration_s;
  return config;
}

double DistanceToSegment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d d = b - a;
  const double share = std::clamp(d.dot(p - a) / std::max(d.squaredNorm(), 1e-12), 0.0, 1.0);
  return (a + share * d - p).norm();
}

double DistanceToRoute(const World& world, const Vector3d& p) {
  double best = 1e9;
  const std::size_t count = world.route.size();
  for (std::size_t i = 0; i + (world.closed ? 0 : 1) < count; ++i) {
    best = std::min(best, DistanceToSegment(p, world.route[i], world.route[(i + 1) % count]));
  }
  return best;
}

class StyleTest : public testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<Motion> Make(const World& world, double duration_s) const {
    return MakeMotion(world, Config(GetParam(), duration_s));
  }
};

TEST_P(StyleTest, DerivativesAgreeWithCentralDifferences) {
  const auto motion = Make(MotionLoop(), 60.0);
  const double h = 1e-4;
  for (double t = 1.9; t < 59.0; t += 0.137) {
    const MotionState state = motion->At(t);
    const MotionState before = motion->At(t - h);
    const MotionState after = motion->At(t + h);
    const Vector3d velocity =
        (after.T_world_body.translation() - before.T_world_body.translation()) / (2 * h);
    const Vector3d acceleration = (after.velocity - before.velocity) / (2 * h);
    const Eigen::Matrix3d step =
        before.T_world_body.linear().transpose() * after.T_world_body.linear();
    const Vector3d angular_velocity = so3::Log(step) / (2 * h);
    const Vector3d angular_acceleration =
        (after.angular_velocity - before.angular_velocity) / (2 * h);
    EXPECT_LT((velocity - state.velocity).norm(), 1e-5) << t;
    EXPECT_LT((acceleration - state.acceleration).norm(), 1e-4) << t;
    EXPECT_LT((angular_velocity - state.angular_velocity).norm(), 1e-5) << t;
    EXPECT_LT((angular_acceleration - state.angular_acceleration).norm(), 1e-3) << t;
  }
}

TEST_P(StyleTest, StandsPerfectlyStillAtTheStart) {
  const auto motion = Make(MotionLoop(), 20.0);
  const Pose start = motion->At(0.0).T_world_body;
  for (double t = 0.0; t <= 2.0; t += 0.05) {
    const MotionState state = motion->At(t);
    EXPECT_LT((start.matrix() - state.T_world_body.matrix()).norm(), 1e-13) << t;
    EXPECT_LT(state.velocity.norm() + state.acceleration.norm(), 1e-12) << t;
    EXPECT_LT(state.angular_velocity.norm() + state.angular_acceleration.norm(), 1e-12) << t;
  }
  const Pose later = motion->At(6.0).T_world_body;
  EXPECT_GT((later.translation() - start.translation()).norm(), 0.5);
}

TEST_P(StyleTest, FollowsTheRoute) {
  for (World world : {MotionLoop(), MotionHall()}) {
    const auto motion = Make(world, 90.0);
    for (Vector3d& waypoint : world.route) waypoint.z() = 0.0;
    double travelled = 0.0;
    for (double t = 0.0; t < 90.0; t += 0.05) {
      const MotionState state = motion->At(t);
      Vector3d feet = state.T_world_body.translation();
      feet.z() = 0.0;
      EXPECT_LT(DistanceToRoute(world, feet), 0.3) << world.name << " at " << t;
      travelled += 0.05 * state.velocity.norm();
    }
    EXPECT_GT(travelled, 35.0) << world.name;
  }
}

TEST_P(StyleTest, MovesWithoutJolts) {
  const auto motion = Make(MotionLoop(), 60.0);
  MotionState last = motion->At(0.0);
  for (double t = 1e-3; t < 60.0; t += 1e-3) {
    const MotionState state = motion->At(t);
    ASSERT_LT((state.acceleration - last.acceleration).norm(), 1.0) << t;
    ASSERT_LT(state.acceleration.norm(), 30.0) << t;
    last = state;
  }
}

TEST_P(StyleTest, LooksWhereItGoes) {
  const auto motion = Make(MotionLoop(), 60.0);
  double along = 0.0;
  double all = 0.0;
  for (double t = 0.0; t < 60.0; t += 0.02) {
    const MotionState state = motion->At(t);
    along += state.velocity.dot(state.T_world_body.linear().col(0));
    all += state.velocity.norm();
  }
  EXPECT_GT(along, 0.8 * all);
}

INSTANTIATE_TEST_SUITE_P(Styles, StyleTest, testing::ValuesIn(MotionStyles()),
                         [](const auto& test) { return test.param; });

double PeakRotationRate(const std::string& style) {
  const auto motion = MakeMotion(MotionLoop(), Config(style, 60.0));
  double peak = 0.0;
  for (double t = 0.0; t < 60.0; t += 0.01) {
    peak = std::max(peak, motion->At(t).angular_velocity.norm());
  }
  return peak * 180.0 / M_PI;
}

TEST(MotionTest, StylesDifferInHowFastTheyTurn) {
  EXPECT_LT(PeakRotationRate("robot"), 70.0);
  EXPECT_LT(PeakRotationRate("walk"), 120.0);
  EXPECT_GT(PeakRotationRate("aggressive"), 150.0);
  EXPECT_LT(PeakRotationRate("aggressive"), 220.0);
}

TEST(MotionTest, RobotStopsNowAndThen) {
  World world = MotionHall();
  world.route = {{0, 0, 0}, {200, 0, 0}};
  const auto motion = MakeMotion(world, Config("robot", 120.0));
  int stops = 0;
  bool moving = false;
  for (double t = 3.0; t < 120.0; t += 0.1) {
    const double speed = motion->At(t).velocity.head<2>().norm();
    if (speed > 0.3) moving = true;
    if (moving && speed < 1e-3) {
      moving = false;
      ++stops;
    }
  }
  EXPECT_GE(stops, 1);
  EXPECT_LE(stops, 6);
}

TEST(MotionTest, AttachedFrameObeysItsOwnDerivatives) {
  const auto motion = MakeMotion(MotionLoop(), Config("aggressive", 30.0));
  const Pose T_body_frame = MakePose(RotationFromRpy(0.3, -1.0, 2.0), Vector3d(0.4, -0.2, 0.3));
  const double h = 1e-4;
  for (double t = 3.0; t < 29.0; t += 0.31) {
    const MotionState state = Attached(motion->At(t), T_body_frame);
    const MotionState before = Attached(motion->At(t - h), T_body_frame);
    const MotionState after = Attached(motion->At(t + h), T_body_frame);
    const Vector3d velocity =
        (after.T_world_body.translation() - before.T_world_body.translation()) / (2 * h);
    EXPECT_LT((velocity - state.velocity).norm(), 1e-5);
    EXPECT_LT(((after.velocity - before.velocity) / (2 * h) - state.acceleration).norm(), 1e-4);
    const Eigen::Matrix3d step =
        before.T_world_body.linear().transpose() * after.T_world_body.linear();
    EXPECT_LT((so3::Log(step) / (2 * h) - state.angular_velocity).norm(), 1e-5);
  }
}

TEST(MotionTest, SeedChangesTheSwayAndNothingElseDoes) {
  MotionConfig config = Config("walk", 20.0);
  const Pose first = MakeMotion(MotionLoop(), config)->At(10.0).T_world_body;
  EXPECT_EQ(
      (first.matrix() - MakeMotion(MotionLoop(), config)->At(10.0).T_world_body.matrix()).norm(),
      0.0);
  config.seed = 2;
  EXPECT_GT(
      (first.matrix() - MakeMotion(MotionLoop(), config)->At(10.0).T_world_body.matrix()).norm(),
      1e-3);
}

TEST(MotionTest, CanStartInMotion) {
  MotionConfig config = Config("walk", 30.0);
  const auto whole = MakeMotion(MotionLoop(), config);
  config.skip_s = 10.0;
  const auto later = MakeMotion(MotionLoop(), config);
  EXPECT_GT(later->At(0.0).velocity.norm(), 0.3);
  for (double t = 0.0; t < 20.0; t += 1.3) {
    const Pose expected = whole->At(t + 10.0).T_world_body;
    EXPECT_LT((later->At(t).T_world_body.matrix() - expected.matrix()).norm(), 1e-9);
  }
}

TEST(MotionTest, RefusesWhatItCannotDo) {
  EXPECT_THROW(MakeMotion(MotionLoop(), Config("fly", 10.0)), InputError);
  World world = MotionLoop();
  world.route.resize(1);
  EXPECT_THROW(MakeMotion(world, Config("walk", 10.0)), InputError);
}

class WorldMotionTest : public testing::TestWithParam<std::string> {};

TEST_P(WorldMotionTest, KeepsItsDistanceFromEverythingStatic) {
  const World world = MakeWorld(GetParam(), 1);
  const LidarSimulator lidar(world, PandarXt32(), LidarOptions(), 1);
  for (const std::string& style : MotionStyles()) {
    const auto motion = MakeMotion(world, Config(style, 240.0));
    double nearest = 1e9;
    for (double t = 0.0; t < 240.0; t += 0.2) {
      const Vector3d sensor = motion->At(t).T_world_body.translation();
      nearest = std::min(nearest, lidar.DistanceToSurface(sensor, 2.0));
    }
    EXPECT_GT(nearest, 0.55) << style;
  }
}

INSTANTIATE_TEST_SUITE_P(Worlds, WorldMotionTest, testing::ValuesIn(WorldNames()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace hv::sim
