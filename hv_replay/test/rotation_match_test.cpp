#include "hv_replay/rotation_match.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "hv_core/se3.h"
#include "hv_core/so3.h"

namespace hv::replay {
namespace {

const Time kEpoch = Time::FromNanoseconds(1646310000000000000);

/// Angular velocity of the IMU at time t [rad/s]; `axes` of them move.
Eigen::Vector3d RateAt(double t, int axes) {
  Eigen::Vector3d rate(0.0, 0.0, 0.5 * std::sin(0.7 * t) + 0.3 * std::sin(5.1 * t));
  if (axes > 1) rate.x() = 0.4 * std::sin(6.3 * t + 1.0);
  if (axes > 1) rate.y() = 0.3 * std::cos(4.4 * t);
  return rate;
}

struct Scene {
  double offset_s = 0.0;
  double scale = 1.0;
  int axes = 3;
  double noise = 0.0;  ///< of the LiDAR's rotations [rad]
  Eigen::Matrix3d R_imu_lidar = RotationFromRpy(0.4, -0.8, 2.0);
  std::vector<RotationStep> lidar;
  std::vector<ImuSample> gyro;

  void Make() {
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 6000; ++i) {
      ImuSample sample;
      sample.stamp = kEpoch + 0.005 * i + offset_s;
      sample.angular_velocity =
          scale * (RateAt(0.005 * i, axes) + Eigen::Vector3d(0.01, -0.02, 0.03));
      gyro.push_back(sample);
    }
    for (int i = 10; i < 280; ++i) {
      Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();
      for (int k = 0; k < 100; ++k) {
        turned = turned * so3::Exp(0.001 * RateAt(0.1 * i + 0.001 * (k + 0.5), axes));
      }
      const Eigen::Vector3d jitter(normal(random), normal(random), normal(random));
      lidar.push_back({kEpoch + 0.1 * i, kEpoch + 0.1 * (i + 1),
                       R_imu_lidar.transpose() * so3::Log(turned) + noise * jitter});
    }
  }
};

double AngleBetween(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return so3::Log(a.transpose() * b).norm();
}

TEST(RotationMatch, FindsOffsetRotationAndScale) {
  for (const double offset : {-0.31, -0.035, 0.0, 0.0125, 0.2}) {
    Scene scene;
    scene.offset_s = offset;
    scene.noise = 2e-3;
    scene.Make();
    const std::optional<RotationMatch> match = MatchRotations(scene.lidar, scene.gyro);
    ASSERT_TRUE(match.has_value());
    EXPECT_NEAR(match->offset_s, offset, 2e-3);
    EXPECT_GT(match->correlation, 0.95);
    EXPECT_TRUE(match->all_axes);
    EXPECT_NEAR(match->gyro_scale, 1.0, 0.02);
    EXPECT_LT(AngleBetween(match->R_imu_lidar, scene.R_imu_lidar), 0.02);
  }
}

TEST(RotationMatch, SeesDegrees) {
  Scene scene;
  scene.scale = 57.2957795;
  scene.Make();
  EXPECT_NEAR(MatchRotations(scene.lidar, scene.gyro)->gyro_scale, 57.3, 0.3);
}

TEST(RotationMatch, SlippedScansDoNotMatter) {
  Scene scene;
  scene.Make();
  for (std::size_t i = 5; i < scene.lidar.size(); i += 15) {
    scene.lidar[i].rotation += Eigen::Vector3d(0.5, -0.4, 0.3);
  }
  const std::optional<RotationMatch> match = MatchRotations(scene.lidar, scene.gyro);
  ASSERT_TRUE(match.has_value());
  EXPECT_NEAR(match->offset_s, 0.0, 2e-3);
  EXPECT_LT(AngleBetween(match->R_imu_lidar, scene.R_imu_lidar), 0.01);
}

TEST(RotationMatch, OneAxisGivesOffsetButNoFullRotation) {
  Scene scene;
  scene.axes = 1;
  scene.offset_s = 0.05;
  scene.Make();
  const std::optional<RotationMatch> match = MatchRotations(scene.lidar, scene.gyro);
  ASSERT_TRUE(match.has_value());
  EXPECT_NEAR(match->offset_s, 0.05, 2e-3);
  EXPECT_FALSE(match->all_axes);
  EXPECT_NEAR(match->CorrelationWith(scene.R_imu_lidar), match->correlation, 1e-3);
}

TEST(RotationMatch, TellsARotationFromItsInverse) {
  Scene scene;
  scene.Make();
  const std::optional<RotationMatch> match = MatchRotations(scene.lidar, scene.gyro);
  EXPECT_GT(match->CorrelationWith(scene.R_imu_lidar), 0.99);
  EXPECT_LT(match->CorrelationWith(scene.R_imu_lidar.transpose()), 0.5);
}

TEST(RotationMatch, TooLittleIsSaid) {
  Scene scene;
  scene.Make();
  EXPECT_FALSE(MatchRotations({}, scene.gyro).has_value());
  EXPECT_FALSE(MatchRotations(scene.lidar, {}).has_value());
  for (RotationStep& step : scene.lidar) step.rotation *= 1e-3;
  EXPECT_FALSE(MatchRotations(scene.lidar, scene.gyro).has_value());
}

TEST(RotationMatch, UnrelatedRotationsDoNotCorrelate) {
  Scene scene;
  scene.Make();
  std::mt19937 random(8);
  std::normal_distribution<double> normal;
  for (RotationStep& step : scene.lidar) {
    step.rotation = 0.05 * Eigen::Vector3d(normal(random), normal(random), normal(random));
  }
  const std::optional<RotationMatch> match = MatchRotations(scene.lidar, scene.gyro);
  ASSERT_TRUE(match.has_value());
  EXPECT_LT(match->correlation, 0.5);
}

}  // namespace
}  // namespace hv::replay
