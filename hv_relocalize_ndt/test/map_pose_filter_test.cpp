#include "hv_relocalize_ndt/map_pose_filter.h"

#include <random>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "hv_core/angles.h"

namespace hv::relocalize {
namespace {

Matrix6d Diagonal(double sigma_m, double sigma_rad) {
  Vector6d variances;
  variances.head<3>().setConstant(sigma_m * sigma_m);
  variances.tail<3>().setConstant(sigma_rad * sigma_rad);
  return variances.asDiagonal();
}

Pose RandomPose(std::mt19937& random, double spread_m, double spread_rad) {
  std::normal_distribution<double> normal;
  Vector6d tangent;
  for (int k = 0; k < 6; ++k) tangent[k] = (k < 3 ? spread_m : spread_rad) * normal(random);
  return se3::Exp(tangent);
}

void ExpectCovariance(const Matrix6d& covariance) {
  EXPECT_LT((covariance - covariance.transpose()).norm(), 1e-12);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix6d>(covariance).eigenvalues()[0], 0.0);
}

TEST(MapPoseFilterTest, OdometryCarriesThePose) {
  std::mt19937 random(1);
  const Pose T_map_odom = MakePose(RotationFromRpy(0.0, 0.0, 2.0), {5.0, -3.0, 0.2});
  Pose T_odom_imu = RandomPose(random, 2.0, 0.1);
  MapPoseFilter filter((TrackingConfig()));
  filter.Start(T_odom_imu, T_map_odom * T_odom_imu, Diagonal(0.02, 0.002));
  double last_m = filter.sigma_m();
  for (int i = 0; i < 20; ++i) {
    T_odom_imu = T_odom_imu * RandomPose(random, 0.3, 0.1);
    filter.Predict(T_odom_imu, 0.1);
    EXPECT_TRUE(filter.T_map_odom().isApprox(T_map_odom, 1e-9));
    EXPECT_GT(filter.sigma_m(), last_m);
    last_m = filter.sigma_m();
    ExpectCovariance(filter.covariance());
  }
}

/// An error of heading at the start is one of position further on.
TEST(MapPoseFilterTest, ErrorsAreCarriedAlong) {
  const double heading = 0.02;
  Matrix6d covariance = Diagonal(1e-6, 1e-6);
  covariance(5, 5) = heading * heading;
  MapPoseFilter filter((TrackingConfig()));
  filter.Start(Pose::Identity(), Pose::Identity(), covariance);
  Pose ahead = Pose::Identity();
  ahead.translation().x() = 10.0;
  filter.Predict(ahead, 0.0);
  const double drifted = TrackingConfig().drift_translation * 10.0;
  EXPECT_NEAR(filter.covariance()(1, 1), 100.0 * heading * heading + drifted * drifted, 1e-6);
  EXPECT_NEAR(filter.covariance()(0, 0), drifted * drifted, 1e-6);
}

TEST(MapPoseFilterTest, DriftGrowsWithTheDistanceInStepsOfAnyLength) {
  TrackingConfig config;
  config.drift_rotation_deg = config.drift_tilt_deg = 1e-6;  // it would be one of position, too
  for (const int steps : {1, 7, 200}) {
    MapPoseFilter filter(config);
    filter.Start(Pose::Identity(), Pose::Identity(), Diagonal(1e-6, 1e-9));
    Pose ahead = Pose::Identity();
    for (int i = 1; i <= steps; ++i) {
      ahead.translation().x() = 20.0 * i / steps;
      filter.Predict(ahead, 0.0);
    }
    EXPECT_NEAR(filter.sigma_m(), std::sqrt(3.0) * config.drift_translation * 20.0, 1e-4) << steps;
    filter.Correct(ahead, Diagonal(0.01, 0.001));
    const double corrected_m = filter.sigma_m();
    ahead.translation().x() += 0.1;
    filter.Predict(ahead, 0.0);
    EXPECT_LT(filter.sigma_m(), corrected_m + 0.001) << steps;
  }
}

TEST(MapPoseFilterTest, AnExactMeasurementIsTaken) {
  const Pose measured = MakePose(RotationFromRpy(0.0, 0.0, 0.3), {1.0, 2.0, 0.1});
  MapPoseFilter filter((TrackingConfig()));
  filter.Start(Pose::Identity(),
               measured * se3::Exp((Vector6d() << 0.2, 0.1, 0, 0, 0, 0.05).finished()),
               Diagonal(0.5, 0.1));
  EXPECT_GT(filter.Distance(measured, Diagonal(0.001, 0.001)), 0.1);
  filter.Correct(measured, Diagonal(1e-4, 1e-4));
  EXPECT_LT((filter.T_map_imu().translation() - measured.translation()).norm(), 1e-3);
  EXPECT_LT(RotationDistance(filter.T_map_imu(), measured), 1e-3);
  EXPECT_LT(filter.sigma_m(), 1e-3);
  ExpectCovariance(filter.covariance());
}

TEST(MapPoseFilterTest, GravityHoldsThePoseUpright) {
  const Pose T_odom_imu = MakePose(RotationFromRpy(0.1, -0.2, 0.7), {0.0, 0.0, 1.0});
  const Pose tilted =
      MakePose(RotationFromRpy(5.0 * kRadiansPerDegree, 0.0, 0.0), {3.0, 4.0, 0.0}) * T_odom_imu;
  MapPoseFilter filter((TrackingConfig()));
  filter.Start(T_odom_imu, tilted, Diagonal(0.1, 0.2));
  filter.Correct(tilted, Diagonal(0.05, 2.0 * kRadiansPerDegree));
  const Eigen::Vector3d up_by_map = filter.T_map_imu().linear().row(2);
  const Eigen::Vector3d up = T_odom_imu.linear().row(2);
  EXPECT_LT(std::acos(std::min(1.0, up.dot(up_by_map))), 0.3 * kRadiansPerDegree);
}

}  // namespace
}  // namespace hv::relocalize
