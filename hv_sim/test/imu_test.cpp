#include "hv_sim/imu_simulator.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "hv_sim/sensor_suite.h"
#include "strapdown.h"

namespace hv::sim {
namespace {

using Eigen::Vector3d;

World LoopWorld() {
  World world;
  world.name = "loop";
  world.route = {{0, 0, 0}, {9, 0, 0}, {9, 7, 0}, {5, 12, 0.5}, {-3, 9, 0}, {-3, 3, 0}};
  return world;
}

class ImuStyleTest : public testing::TestWithParam<std::string> {};

TEST_P(ImuStyleTest, NoiseFreeReadingsIntegrateBackToTheTruth) {
  MotionConfig motion_config;
  motion_config.style = GetParam();
  motion_config.duration_s = 60.0;
  const auto motion = MakeMotion(LoopWorld(), motion_config);
  ImuConfig imu_config;
  imu_config.noise = false;
  ImuSimulator imu(imu_config, 1);
  const Pose T_body_imu = MakeRig(DefaultSuite("hilti")).T_body_imu();
  const double period = 1.0 / imu_config.rate_hz;
  const auto measure = [&](int k) {
    const MotionState state = Attached(motion->At(k * period), T_body_imu);
    return imu.Measure(IdealImu(Time::FromSeconds(k * period), state));
  };
  Strapdown strapdown(Attached(motion->At(0.0), T_body_imu));
  const int count = static_cast<int>(60.0 * imu_config.rate_hz);
  ImuSample first = measure(0);
  for (int k = 0; k < count; k += 2) {
    const ImuSample last = measure(k + 2);
    strapdown.Step(first, measure(k + 1), last, period);
    first = last;
  }
  const Pose truth = Attached(motion->At(60.0), T_body_imu).T_world_body;
  EXPECT_GT((truth.translation() - motion->At(0.0).T_world_body.translation()).norm(), 1.0);
  EXPECT_LT((strapdown.pose().translation() - truth.translation()).norm(), 0.002);
  EXPECT_LT(RotationDistance(strapdown.pose(), truth) * 180.0 / M_PI, 0.005);
}

INSTANTIATE_TEST_SUITE_P(Styles, ImuStyleTest, testing::ValuesIn(MotionStyles()),
                         [](const auto& test) { return test.param; });

TEST(ImuTest, AtRestReadsGravityUpInEveryMounting) {
  for (const std::string& format : FormatNames()) {
    const SensorRig rig = MakeRig(DefaultSuite(format));
    const ImuSample sample = IdealImu(Time(), Attached(MotionState(), rig.T_body_imu()));
    const Vector3d up = rig.T_body_imu().linear() * sample.acceleration;
    EXPECT_LT((up - Vector3d(0, 0, kGravity)).norm(), 1e-6) << format;
    EXPECT_EQ(sample.angular_velocity.norm(), 0.0);
  }
  const ImuSample hilti =
      IdealImu(Time(), Attached(MotionState(), MakeRig(DefaultSuite("hilti")).T_body_imu()));
  EXPECT_NEAR(hilti.acceleration.z(), -kGravity, 1e-5);
}

TEST(ImuTest, LidarSitsLevelAtTheOriginOfTheBody) {
  for (const std::string format : {"hilti", "robot"}) {
    const Pose T_body_lidar = MakeRig(DefaultSuite(format)).T_body_lidar();
    EXPECT_LT(T_body_lidar.translation().norm(), 1e-9) << format;
    EXPECT_NEAR(T_body_lidar.linear()(2, 2), 1.0, 1e-6) << format;
  }
  const Pose T_body_lidar = MakeRig(DefaultSuite("nclt")).T_body_lidar();
  EXPECT_LT(T_body_lidar.linear()(2, 2), -0.99) << "NCLT carries its LiDAR upside down";
}

struct Statistics {
  Vector3d mean = Vector3d::Zero();
  Vector3d sigma = Vector3d::Zero();
};

Statistics Of(const std::vector<Vector3d>& values) {
  Statistics result;
  for (const Vector3d& v : values) result.mean += v / static_cast<double>(values.size());
  Vector3d variance = Vector3d::Zero();
  for (const Vector3d& v : values) {
    variance += (v - result.mean).cwiseAbs2() / static_cast<double>(values.size() - 1);
  }
  result.sigma = variance.cwiseSqrt();
  return result;
}

TEST(ImuTest, WhiteNoiseHasItsDensity) {
  ImuConfig config;
  config.gyro_bias_walk = config.accel_bias_walk = 0.0;
  ImuSimulator imu(config, 7);
  std::vector<Vector3d> gyro;
  std::vector<Vector3d> accel;
  for (int k = 0; k < 40000; ++k) {
    const ImuSample sample = imu.Measure(ImuSample());
    gyro.push_back(sample.angular_velocity - imu.gyro_bias());
    accel.push_back(sample.acceleration - imu.accel_bias());
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(Of(gyro).sigma[axis] / (1.9e-4 * 20.0), 1.0, 0.02);
    EXPECT_NEAR(Of(accel).sigma[axis] / (1.32e-3 * 20.0), 1.0, 0.02);
    EXPECT_NEAR(Of(gyro).mean[axis], 0.0, 5.0 * 1.9e-4 * 20.0 / 200.0);
  }
  EXPECT_GT(imu.gyro_bias().norm(), 1e-4);
  EXPECT_LT(imu.gyro_bias().norm(), 6.0 * config.gyro_bias_sigma);
}

TEST(ImuTest, BiasesWalkWithTheRootOfTime) {
  ImuConfig config;
  config.rate_hz = 100.0;
  constexpr double kSeconds = 25.0;
  std::vector<Vector3d> gyro;
  std::vector<Vector3d> accel;
  for (std::uint32_t seed = 1; seed <= 400; ++seed) {
    ImuSimulator imu(config, seed);
    const Vector3d gyro_start = imu.gyro_bias();
    const Vector3d accel_start = imu.accel_bias();
    for (int k = 0; k < kSeconds * config.rate_hz; ++k) imu.Measure(ImuSample());
    gyro.push_back(imu.gyro_bias() - gyro_start);
    accel.push_back(imu.accel_bias() - accel_start);
  }
  const double gyro_sigma = config.gyro_bias_walk * std::sqrt(kSeconds);
  const double accel_sigma = config.accel_bias_walk * std::sqrt(kSeconds);
  EXPECT_NEAR(Of(gyro).sigma.mean() / gyro_sigma, 1.0, 0.1);
  EXPECT_NEAR(Of(accel).sigma.mean() / accel_sigma, 1.0, 0.1);
}

TEST(ImuTest, SaturatesAndQuantisesOnRequest) {
  ImuConfig config;
  config.noise = false;
  config.gyro_range = 2.0;
  config.accel_resolution = 0.5;
  ImuSimulator imu(config, 1);
  ImuSample ideal;
  ideal.angular_velocity = {-3.0, 1.0, 2.5};
  ideal.acceleration = {0.26, -0.74, 9.81};
  const ImuSample sample = imu.Measure(ideal);
  EXPECT_EQ(sample.angular_velocity, Vector3d(-2.0, 1.0, 2.0));
  EXPECT_LT((sample.acceleration - Vector3d(0.5, -0.5, 10.0)).norm(), 1e-12);
}

TEST(ImuTest, ConfigurationIsChecked) {
  ImuConfig config;
  config.gyro_noise = -1.0;
  config.rate_hz = 0.0;
  ConfigProblems problems;
  config.Validate(problems);
  EXPECT_EQ(problems.lines().size(), 2U);
}

}  // namespace
}  // namespace hv::sim
