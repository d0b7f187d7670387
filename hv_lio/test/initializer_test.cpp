#include "hv_lio/initializer.h"

#include <random>

#include <gtest/gtest.h>

#include "random_state.h"

namespace hv::lio {
namespace {

void Feed(Initializer& initializer, double duration, const Eigen::Vector3d& force,
          double shake, const Eigen::Vector3d& gyro_bias = Eigen::Vector3d::Zero()) {
  std::mt19937 random(1);
  for (int i = 0; i < static_cast<int>(duration * 200.0); ++i) {
    ImuSample sample;
    sample.stamp = Time::FromSeconds(50.0 + i / 200.0);
    sample.acceleration = force + RandomVector(random, shake * force.norm());
    sample.angular_velocity = gyro_bias + RandomVector(random, shake);
    initializer.Add(sample);
  }
}

TEST(InitializerTest, RestGivesTiltAndGyroBias) {
  Initializer initializer{InitializerConfig()};
  const Eigen::Vector3d up = Eigen::Vector3d(0.3, -0.2, 1.0).normalized();
  const Eigen::Vector3d bias(0.01, -0.02, 0.005);
  Feed(initializer, 1.0, 9.80665 * up, 0.003, bias);
  const auto initial = initializer.TryInitialize();
  ASSERT_TRUE(initial.has_value());
  EXPECT_FALSE(initial->moving);
  EXPECT_EQ(initial->accel_scale, 1.0);
  EXPECT_LT((initial->state.rotation * up - Eigen::Vector3d::UnitZ()).norm(), 2e-3);
  EXPECT_LT((initial->state.gyro_bias - bias).norm(), 1e-3);
}

TEST(InitializerTest, UnitOfGIsRecognised) {
  Initializer initializer{InitializerConfig()};
  Feed(initializer, 1.0, Eigen::Vector3d(0.0, 0.0, 1.0), 0.003);
  EXPECT_NEAR(initializer.TryInitialize().value().accel_scale, 9.80665, 1e-9);
}

TEST(InitializerTest, MotionIsWaitedOutThenAcceptedWithAWiderCovariance) {
  Initializer initializer{InitializerConfig()};
  Feed(initializer, 2.0, Eigen::Vector3d(0.0, 0.0, 9.8), 0.3);
  EXPECT_FALSE(initializer.TryInitialize().has_value());
  EXPECT_NE(initializer.WaitingFor().find("waiting for rest"), std::string::npos);
  Initializer longer{InitializerConfig()};
  Feed(longer, 3.5, Eigen::Vector3d(0.0, 0.0, 9.8), 0.3);
  const auto initial = longer.TryInitialize();
  ASSERT_TRUE(initial.has_value());
  EXPECT_TRUE(initial->moving);
  EXPECT_GT(initial->covariance(ErrorIndex::kVelocity, ErrorIndex::kVelocity), 1.0);
}

TEST(InitializerTest, TurningSensorStillFindsUp) {
  Initializer initializer{InitializerConfig()};
  Eigen::Matrix3d R_world_imu = Eigen::Matrix3d::Identity();
  const Eigen::Vector3d rate(1.0, -0.7, 0.5);
  for (int i = 0; i < 700; ++i) {
    ImuSample sample;
    sample.stamp = Time::FromSeconds(50.0 + i / 200.0);
    sample.angular_velocity = rate;
    const Eigen::Vector3d shaking(3.0 * std::sin(0.2 * i), 2.0 * std::cos(0.15 * i), 0.0);
    sample.acceleration =
        R_world_imu.transpose() * (Eigen::Vector3d(0.0, 0.0, 9.80665) + shaking);
    initializer.Add(sample);
    if (i < 699) R_world_imu = R_world_imu * so3::Exp(rate / 200.0);
  }
  const auto initial = initializer.TryInitialize();
  ASSERT_TRUE(initial.has_value());
  EXPECT_TRUE(initial->moving);
  const Eigen::Vector3d up = R_world_imu.transpose() * Eigen::Vector3d::UnitZ();
  EXPECT_LT((initial->state.rotation * up - Eigen::Vector3d::UnitZ()).norm(), 0.03);
}

TEST(InitializerTest, ImpossibleGravityIsNamed) {
  Initializer initializer{InitializerConfig()};
  Feed(initializer, 5.0, Eigen::Vector3d(0.0, 0.0, 3.0), 0.003);
  EXPECT_FALSE(initializer.TryInitialize().has_value());
  EXPECT_NE(initializer.WaitingFor().find("3.00"), std::string::npos);
}

TEST(InitializerTest, TooFewSamplesAreNotEnough) {
  Initializer initializer{InitializerConfig()};
  EXPECT_FALSE(initializer.TryInitialize().has_value());
  EXPECT_EQ(initializer.WaitingFor(), "waiting for IMU samples");
}

}  // namespace
}  // namespace hv::lio
