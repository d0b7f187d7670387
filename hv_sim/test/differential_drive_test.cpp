#include "hv_sim/differential_drive.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace hv::sim {
namespace {

using Eigen::Vector2d;

DifferentialDriveConfig WithoutSlip() {
  DifferentialDriveConfig config;
  config.slip = 0.0;
  config.command_timeout_s = 100.0;
  return config;
}

void Drive(DifferentialDrive& drive, double seconds, double dt = 0.01) {
  const auto steps = static_cast<int>(std::lround(seconds / dt));
  for (int k = 0; k < steps; ++k) drive.Step(dt);
}

TEST(DifferentialDriveTest, DrivesTheArcThatIsCommanded) {
  DifferentialDriveConfig config = WithoutSlip();
  config.linear_acceleration = config.angular_acceleration = 1e9;
  DifferentialDrive drive(config, 1);
  drive.Place({2.0, -1.0}, 0.7);
  ASSERT_TRUE(drive.Command({0.6, 0.9}));
  drive.Step(1e-9);  // up to speed
  Drive(drive, 4.0);
  const double turn = 0.9 * 4.0;
  const double radius = 0.6 / 0.9;
  const Vector2d expected =
      Vector2d(2.0, -1.0) +
      radius * Vector2d(std::sin(0.7 + turn) - std::sin(0.7), std::cos(0.7) - std::cos(0.7 + turn));
  EXPECT_NEAR(drive.state().yaw, 0.7 + turn, 1e-8);
  EXPECT_LT((drive.state().position - expected).norm(), 1e-8);
}

TEST(DifferentialDriveTest, StepsOfAnyLengthGiveTheSameWay) {
  // Both accelerations are constant until 0.5 s.
  DifferentialDrive coarse(WithoutSlip(), 1);
  DifferentialDrive fine(WithoutSlip(), 1);
  coarse.Command({1.0, 1.5});
  fine.Command({1.0, 1.5});
  Drive(coarse, 0.5, 0.1);
  Drive(fine, 0.5, 0.0005);
  EXPECT_GT(fine.state().position.norm(), 0.08);
  EXPECT_LT((coarse.state().position - fine.state().position).norm(), 1e-9);
  EXPECT_NEAR(coarse.state().yaw, fine.state().yaw, 1e-12);
}

TEST(DifferentialDriveTest, LimitsHoldWhateverIsCommanded) {
  const DifferentialDriveConfig config = WithoutSlip();
  DifferentialDrive drive(config, 1);
  Random random({5U});
  constexpr double kStep = 0.01;
  DriveCommand last;
  for (int k = 0; k < 5000; ++k) {
    if (k % 70 == 0) drive.Command({random.Uniform(-3.0, 3.0), random.Uniform(-5.0, 5.0)});
    drive.Step(kStep);
    const DriveCommand now = drive.state().velocity;
    EXPECT_LE(std::abs(now.linear_mps), config.max_linear_mps + 1e-12);
    EXPECT_LE(std::abs(now.angular_rps), config.max_angular_rps + 1e-12);
    const double gain = std::abs(now.linear_mps) - std::abs(last.linear_mps);
    EXPECT_LE(gain, config.linear_acceleration * kStep + 1e-12);
    EXPECT_GE(gain, -config.linear_deceleration * kStep - 1e-12);
    const double turn_gain = std::abs(now.angular_rps) - std::abs(last.angular_rps);
    EXPECT_LE(turn_gain, config.angular_acceleration * kStep + 1e-12);
    EXPECT_GE(turn_gain, -config.angular_deceleration * kStep - 1e-12);
    last = now;
  }
}

TEST(DifferentialDriveTest, BrakesWhenCommandsStop) {
  DifferentialDriveConfig config = WithoutSlip();
  config.command_timeout_s = 0.5;
  DifferentialDrive drive(config, 1);
  for (int k = 0; k < 300; ++k) {
    if (k % 40 == 0) drive.Command({0.8, 0.0});
    drive.Step(0.01);
  }
  EXPECT_NEAR(drive.state().velocity.linear_mps, 0.8, 1e-9);
  const double before = drive.state().position.x();
  Drive(drive, 0.45 + 0.8 / 1.2 + 0.1);
  EXPECT_EQ(drive.state().velocity.linear_mps, 0.0);
  EXPECT_LT(drive.state().position.x() - before, 0.8 * 0.5 + 0.5 * 0.8 * 0.8 / 1.2 + 0.01);
}

TEST(DifferentialDriveTest, CommandsThatAreNotFiniteAreRefused) {
  DifferentialDrive drive(WithoutSlip(), 1);
  ASSERT_TRUE(drive.Command({0.5, 0.0}));
  EXPECT_FALSE(drive.Command({std::numeric_limits<double>::quiet_NaN(), 0.0}));
  EXPECT_FALSE(drive.Command({0.5, std::numeric_limits<double>::infinity()}));
  Drive(drive, 2.0);
  EXPECT_NEAR(drive.state().velocity.linear_mps, 0.5, 1e-12);
  EXPECT_EQ(drive.state().yaw, 0.0);
}

TEST(DifferentialDriveTest, HaltStopsAtOnceWhereItStood) {
  DifferentialDrive drive(WithoutSlip(), 1);
  drive.Command({1.0, 0.5});
  Drive(drive, 2.0);
  const DriveState before = drive.state();
  drive.Step(0.01);
  drive.HaltAt(before);
  EXPECT_EQ(drive.state().velocity.linear_mps, 0.0);
  EXPECT_EQ(drive.state().position, before.position);
  drive.Step(0.01);
  EXPECT_NEAR(drive.state().velocity.linear_mps, 0.008, 1e-12);
}

TEST(DifferentialDriveTest, WheelsSlipByTheConfiguredShare) {
  DifferentialDriveConfig config = WithoutSlip();
  config.slip = 0.05;
  config.slip_time_s = 0.2;
  DifferentialDrive drive(config, 3);
  drive.Command({1.0, 0.0});
  Drive(drive, 3.0);
  double speed_mean = 0.0;
  double speed_square = 0.0;
  double turn_square = 0.0;
  constexpr int kSamples = 200000;
  for (int k = 0; k < kSamples; ++k) {
    drive.Command({1.0, 0.0});
    drive.Step(0.01);
    const double deviation = drive.state().velocity.linear_mps - 1.0;
    speed_mean += deviation / kSamples;
    speed_square += deviation * deviation / kSamples;
    turn_square += std::pow(drive.state().velocity.angular_rps, 2) / kSamples;
  }
  // Two independent wheels: sigma / sqrt(2) of the speed, sigma sqrt(2) / track of the turn.
  EXPECT_NEAR(speed_mean, 0.0, 0.004);
  EXPECT_NEAR(std::sqrt(speed_square), 0.05 / std::sqrt(2.0), 0.002);
  EXPECT_NEAR(std::sqrt(turn_square), 0.05 * std::sqrt(2.0) / config.track_m, 0.01);
}

TEST(DifferentialDriveTest, TheSeedDecidesTheSlip) {
  const auto end_of = [](std::uint32_t seed) {
    DifferentialDrive drive({}, seed);
    drive.Command({0.7, 0.2});
    Drive(drive, 0.5);
    return drive.state().position;
  };
  EXPECT_EQ(end_of(4), end_of(4));
  EXPECT_NE(end_of(4), end_of(5));
}

TEST(DifferentialDriveTest, ConfigurationIsChecked) {
  DifferentialDriveConfig config;
  config.track_m = 0.0;
  config.slip = -0.1;
  config.max_linear_mps = std::numeric_limits<double>::quiet_NaN();
  ConfigProblems problems;
  config.Validate(problems);
  EXPECT_EQ(problems.lines().size(), 3U);
}

}  // namespace
}  // namespace hv::sim
