#include "hv_lio/imu_predictor.h"

#include <cmath>

#include <gtest/gtest.h>

namespace hv::lio {
namespace {

constexpr double kGravity_mps2 = 9.80665;

/// Accelerates along x with 1 m/s^2 while level; readings in m/s^2 divided by `unit`.
ImuSample SampleAt(double t, double unit = 1.0) {
  ImuSample sample;
  sample.stamp = Time::FromSeconds(t);
  sample.acceleration = Eigen::Vector3d(1.0, 0.0, kGravity_mps2) / unit;
  return sample;
}

OdometryEstimate EstimateAt(double t, double unit = 1.0) {
  OdometryEstimate estimate;
  estimate.accel_scale = unit;
  estimate.stamp = Time::FromSeconds(t);
  estimate.T_odom_imu.translation().x() = 0.5 * t * t;
  estimate.velocity_odom = {t, 0.0, 0.0};
  estimate.gravity_odom = {0.0, 0.0, -kGravity_mps2};
  estimate.pose_covariance = 1e-4 * Matrix6d::Identity();
  estimate.twist_covariance = 1e-4 * Matrix6d::Identity();
  return estimate;
}

TEST(ImuPredictor, SaysNothingWithoutAnAnchor) {
  ImuPredictor predictor({});
  EXPECT_FALSE(predictor.Add(SampleAt(0.0)));
}

TEST(ImuPredictor, FollowsTheMotionFromALateAnchor) {
  for (const double unit : {1.0, kGravity_mps2}) {
    ImuPredictor predictor({});
    for (int i = 0; i <= 40; ++i) predictor.Add(SampleAt(0.01 * i, unit));
    predictor.Anchor(EstimateAt(0.305, unit));  // between two samples, and older than the newest
    const auto prediction = predictor.Add(SampleAt(0.41, unit));
    ASSERT_TRUE(prediction);
    EXPECT_EQ(prediction->stamp, Time::FromSeconds(0.41));
    EXPECT_NEAR(prediction->T_odom_imu.translation().x(), 0.5 * 0.41 * 0.41, 1e-9);
    EXPECT_NEAR(prediction->velocity_odom.x(), 0.41, 1e-9);
    EXPECT_GT(prediction->pose_covariance(0, 0), 1e-4);
    EXPECT_EQ(prediction->pose_covariance, Matrix6d(prediction->pose_covariance.transpose()));
  }
}

TEST(ImuPredictor, IgnoresDisorderAndInvalidSamples) {
  ImuPredictor predictor({});
  predictor.Add(SampleAt(0.0));
  predictor.Anchor(EstimateAt(0.0));
  ASSERT_TRUE(predictor.Add(SampleAt(0.02)));
  EXPECT_FALSE(predictor.Add(SampleAt(0.01)));
  ImuSample invalid = SampleAt(0.03);
  invalid.acceleration.x() = std::nan("");
  EXPECT_FALSE(predictor.Add(invalid));
  const auto prediction = predictor.Add(SampleAt(0.04));
  ASSERT_TRUE(prediction);
  EXPECT_NEAR(prediction->velocity_odom.x(), 0.04, 1e-9);
}

TEST(ImuPredictor, FallsSilentWithoutScansAndAfterAJumpBack) {
  ImuPredictor predictor({});
  predictor.Anchor(EstimateAt(100.0));
  ASSERT_TRUE(predictor.Add(SampleAt(100.1)));
  EXPECT_FALSE(predictor.Add(SampleAt(100.0 + ImuPredictor::kMaxPrediction + 0.1)));
  EXPECT_FALSE(predictor.Add(SampleAt(1.0)));
  predictor.Anchor(EstimateAt(1.0));
  EXPECT_TRUE(predictor.Add(SampleAt(1.1)));
}

}  // namespace
}  // namespace hv::lio
