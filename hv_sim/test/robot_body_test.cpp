#include "hv_sim/robot_body.h"

#include <cmath>

#include <gtest/gtest.h>

#include "hv_core/error.h"
#include "hv_core/so3.h"
#include "hv_sim/ground.h"
#include "hv_sim/mesh_builder.h"
#include "strapdown.h"

namespace hv::sim {
namespace {

using Eigen::Vector3d;

constexpr double kSlope = 0.12;      ///< of the ramp, 2 m to 6 m ahead
constexpr double kPeriod_s = 0.005;  ///< of the IMU

/// A floor with a wall at x = 12 m, and on the left half a ramp up to a platform that ends at 9 m.
MeshBuilder HallMesh() {
  const double height = 4.0 * kSlope;
  MeshBuilder builder;
  builder.AddQuad({-20.0, -20.0, 0.0}, {40.0, 0.0, 0.0}, {0.0, 20.0, 0.0}, 1.0);
  builder.AddQuad({-20.0, 0.0, 0.0}, {22.0, 0.0, 0.0}, {0.0, 20.0, 0.0}, 1.0);
  builder.AddQuad({2.0, 0.0, 0.0}, {4.0, 0.0, height}, {0.0, 20.0, 0.0}, 1.0);
  builder.AddQuad({6.0, 0.0, height}, {3.0, 0.0, 0.0}, {0.0, 20.0, 0.0}, 1.0);
  builder.AddQuad({12.0, -20.0, 0.0}, {0.0, 40.0, 0.0}, {0.0, 0.0, 2.0}, 1.0);
  return builder;
}

RobotBodyConfig Plain() {
  RobotBodyConfig config;
  config.drive.slip = 0.0;
  config.drive.command_timeout_s = 1e3;
  config.vibration = 0.0;
  return config;
}

struct Robot {
  explicit Robot(const RobotBodyConfig& config, const Pose& T_world_start,
                 std::vector<PersonPath> people = {}, std::uint32_t seed = 1)
      : body(config, std::make_shared<RayCaster>(HallMesh().mesh()), std::move(people), seed) {
    body.Place(T_world_start);
    Run(0.0);
  }

  void Run(double seconds) {
    const auto steps = std::lround(seconds / kPeriod_s);
    for (long k = 0; k < steps; ++k) {
      time_s = kPeriod_s * static_cast<double>(++step);
      Keep(body.AdvanceTo(time_s));
    }
    if (steps == 0) Keep(body.AdvanceTo(time_s));
  }
  void Keep(const std::vector<Contact>& begun) {
    contacts.insert(contacts.end(), begun.begin(), begun.end());
  }
  Vector3d place() const { return body.At(time_s).T_world_body.translation(); }

  RobotBody body;
  long step = 0;
  double time_s = 0.0;
  std::vector<Contact> contacts;
};

TEST(RobotBodyTest, NoiseFreeImuIntegratesBackToTheTruth) {
  RobotBodyConfig config;  // with slip and vibration
  config.drive.command_timeout_s = 1e3;
  Robot robot(config, Upright({-10.0, 8.0, 0.0}));
  Random random({8U});
  const Pose T_base_imu = MakePose(RotationFromRpy(0.2, -0.1, 0.5), Vector3d(-0.06, 0.02, 0.21));
  const auto imu_state = [&] { return Attached(robot.body.At(robot.time_s), T_base_imu); };
  const auto measure = [&] {
    if (robot.step % 300 == 0) {
      robot.body.Command({random.Uniform(-0.2, 1.0), random.Uniform(-1.0, 1.0)});
    }
    robot.Run(kPeriod_s);
    return IdealImu(Time::FromSeconds(robot.time_s), imu_state());
  };
  Strapdown strapdown(imu_state());
  ImuSample first = IdealImu(Time(), imu_state());
  double way = 0.0;
  double worst = 0.0;
  Vector3d last = robot.place();
  for (int k = 0; k < 6000; ++k) {
    const ImuSample middle = measure();
    const ImuSample end = measure();
    strapdown.Step(first, middle, end, kPeriod_s);
    first = end;
    way += (robot.place() - last).norm();
    last = robot.place();
    worst = std::max(
        worst, (strapdown.pose().translation() - imu_state().T_world_body.translation()).norm());
  }
  EXPECT_GT(way, 15.0);
  EXPECT_TRUE(robot.contacts.empty());
  EXPECT_LT(worst, 0.002);
  EXPECT_LT(RotationDistance(strapdown.pose(), imu_state().T_world_body), 1e-5);
}

TEST(RobotBodyTest, DerivativesAreThoseOfThePose) {
  RobotBodyConfig config;
  Robot robot(config, Upright({1.0, 5.0, 0.0}));
  robot.body.Command({0.9, 0.3});
  robot.Run(0.45);
  constexpr double kStep = 1e-5;
  for (double back_s = 0.0; back_s < 0.4; back_s += 0.0137) {
    const double time_s = robot.time_s - back_s;
    const MotionState before = robot.body.At(time_s - kStep);
    const MotionState state = robot.body.At(time_s);
    const MotionState after = robot.body.At(time_s + kStep);
    const auto slope = [](const auto& a, const auto& b) -> Vector3d {
      return (b - a) / (2.0 * kStep);
    };
    const Vector3d velocity =
        slope(before.T_world_body.translation(), after.T_world_body.translation());
    EXPECT_LT((velocity - state.velocity).norm(), 1e-6);
    EXPECT_LT((slope(before.velocity, after.velocity) - state.acceleration).norm(), 1e-4);
    const Vector3d turn =
        so3::Log(before.T_world_body.linear().transpose() * after.T_world_body.linear());
    EXPECT_LT((turn / (2.0 * kStep) - state.angular_velocity).norm(), 1e-6);
    EXPECT_LT((slope(before.angular_velocity, after.angular_velocity) - state.angular_acceleration)
                  .norm(),
              1e-4);
  }
}

TEST(RobotBodyTest, ReachesTheCommandedSpeed) {
  Robot robot(Plain(), Upright({-8.0, -5.0, 0.0}, 0.4));
  robot.body.Command({0.6, 0.0});
  robot.Run(0.02);
  EXPECT_LT((robot.place() - Vector3d(-8.0, -5.0, 0.0)).norm(), 1e-6);
  robot.Run(3.0);
  const MotionState state = robot.body.At(robot.time_s);
  EXPECT_NEAR(state.velocity.norm(), 0.6, 1e-9);
  EXPECT_LT((state.T_world_body.linear().col(0) - state.velocity / 0.6).norm(), 1e-9);
  // 0.6 m/s are reached after 0.75 s; the body follows 20 to 60 ms later.
  const double driven = (robot.place() - Vector3d(-8.0, -5.0, 0.0)).norm();
  EXPECT_NEAR(driven, 0.6 * (3.02 - 0.5 * 0.75 - 0.04), 0.6 * 0.02);
}

TEST(RobotBodyTest, FollowsARamp) {
  Robot robot(Plain(), Upright({0.5, 5.0, 0.0}));
  robot.body.Command({1.0, 0.0});
  double most_acceleration = 0.0;
  double most_pitch = 0.0;
  while (robot.place().x() < 7.5) {
    robot.Run(kPeriod_s);
    const MotionState state = robot.body.At(robot.time_s);
    most_acceleration = std::max(most_acceleration, std::abs(state.acceleration.z()));
    most_pitch = std::max(most_pitch, std::asin(-state.T_world_body.linear()(2, 0)));
    const double x = robot.place().x();
    const double floor = kSlope * std::clamp(x - 2.0, 0.0, 4.0);
    EXPECT_NEAR(robot.place().z(), floor, 0.2 * kSlope) << x;
    if (x > 2.4 && x < 5.6) {
      EXPECT_NEAR(robot.place().z(), floor, 1e-3) << x;
      EXPECT_NEAR(state.T_world_body.linear()(2, 0), std::sin(std::atan(kSlope)), 1e-3) << x;
    }
  }
  EXPECT_TRUE(robot.contacts.empty());
  EXPECT_LT(most_pitch, 1e-3);
  EXPECT_GT(most_acceleration, 0.1);
  EXPECT_LT(most_acceleration, 3.0);
}

TEST(RobotBodyTest, SidewaysOnARampItRolls) {
  Robot robot(Plain(), Upright({4.0, 5.0, 2.0 * kSlope}, M_PI_2));
  const Pose T_world_base = robot.body.At(0.0).T_world_body;
  EXPECT_NEAR(T_world_base.linear()(2, 1), -std::sin(std::atan(kSlope)), 1e-3);
  EXPECT_NEAR(T_world_base.linear()(2, 0), 0.0, 1e-6);
}

TEST(RobotBodyTest, StopsAtAWallAndReportsItOnce) {
  Robot robot(Plain(), Upright({10.0, -5.0, 0.0}, 0.3));
  robot.body.Command({0.8, 0.0});
  const CollisionChecker checker({}, std::make_shared<RayCaster>(HallMesh().mesh()), {});
  double least = 1.0;
  for (int k = 0; k < 1000; ++k) {
    robot.Run(kPeriod_s);
    least =
        std::min(least, checker.At(robot.body.At(robot.time_s).T_world_body, 0.0, 1.0).static_m);
  }
  EXPECT_GT(least, 0.0);
  EXPECT_LT(least, 0.02);
  ASSERT_EQ(robot.contacts.size(), 1U);
  EXPECT_EQ(robot.contacts[0].kind, ContactKind::kObstacle);
  EXPECT_NEAR(robot.contacts[0].velocity.linear_mps, 0.8, 1e-9);
  EXPECT_LT(robot.body.At(robot.time_s).velocity.norm(), 0.02);

  robot.body.Command({-0.5, 0.0});
  robot.Run(1.5);
  EXPECT_LT(robot.place().x(), robot.contacts[0].T_world_base.translation().x() - 0.2);
  EXPECT_EQ(robot.contacts.size(), 1U);
  robot.body.Command({0.5, 0.0});
  robot.Run(3.0);
  EXPECT_EQ(robot.contacts.size(), 2U);
}

TEST(RobotBodyTest, StopsBeforeAnEdge) {
  Robot robot(Plain(), Upright({7.0, 5.0, 4.0 * kSlope}));
  robot.body.Command({0.8, 0.0});
  robot.Run(5.0);
  ASSERT_EQ(robot.contacts.size(), 1U);
  EXPECT_EQ(robot.contacts[0].kind, ContactKind::kEdge);
  EXPECT_LT(robot.place().x(), 9.0);
  EXPECT_GT(robot.place().x(), 8.5);
  EXPECT_NEAR(robot.place().z(), 4.0 * kSlope, 1e-3);
}

TEST(RobotBodyTest, APersonThatWalksIntoItHoldsItUp) {
  PersonPath path;
  path.waypoints = {{-5.0, -10.0, 0.0}, {-5.0, 10.0, 0.0}};
  path.speed = 1.0;
  Robot robot(Plain(), Upright({-5.0, -5.0, 0.0}), {path});
  robot.Run(4.0);
  EXPECT_TRUE(robot.contacts.empty());
  robot.Run(1.0);  // at 5 s she is where the robot stands
  ASSERT_EQ(robot.contacts.size(), 1U);
  EXPECT_EQ(robot.contacts[0].kind, ContactKind::kPerson);
  EXPECT_EQ(robot.contacts[0].velocity.linear_mps, 0.0);
  EXPECT_NEAR(robot.contacts[0].time_s, 5.0, 0.8);
  robot.body.Command({0.5, 0.0});
  robot.Run(0.3);
  EXPECT_LT((robot.place() - Vector3d(-5.0, -5.0, 0.0)).norm(), 0.01);
  robot.Run(3.0);
  EXPECT_GT(robot.place().x(), -4.5);
  EXPECT_EQ(robot.contacts.size(), 1U);
}

TEST(RobotBodyTest, StandsWhereItIsPut) {
  Robot robot({}, Upright({-3.0, -5.0, 0.2}, 2.0));
  robot.body.Command({1.0, 1.0});
  robot.Run(2.0);
  robot.body.Place(Upright({4.0, -8.0, 0.0}, -1.0));
  const Pose T_world_base = robot.body.At(robot.time_s).T_world_body;
  EXPECT_LT((T_world_base.translation() - Vector3d(4.0, -8.0, 0.0)).norm(), 1e-6);
  EXPECT_LT(RotationDistance(T_world_base, Upright(Vector3d::Zero(), -1.0)), 1e-6);
  robot.Run(1.0);
  EXPECT_LT((robot.place() - Vector3d(4.0, -8.0, 0.0)).norm(), 1e-6);
  EXPECT_THROW(robot.body.Place(Upright({100.0, 0.0, 0.0})), InputError);
  EXPECT_THROW(robot.body.Place(Upright({0.0, 0.0, 5.0})), InputError);
}

TEST(RobotBodyTest, TheSeedDecides) {
  const auto end_of = [](std::uint32_t seed) {
    Robot robot({}, Upright({-8.0, -5.0, 0.0}), {}, seed);
    robot.body.Command({0.7, 0.1});
    robot.Run(0.5);
    return robot.body.At(robot.time_s).T_world_body.matrix();
  };
  EXPECT_EQ(end_of(2), end_of(2));
  EXPECT_NE(end_of(2), end_of(3));
}

}  // namespace
}  // namespace hv::sim
