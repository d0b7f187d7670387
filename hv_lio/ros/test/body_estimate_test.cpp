#include "body_estimate.h"

#include <gtest/gtest.h>

#include "hv_core/so3.h"

namespace hv::lio {
namespace {

OdometryEstimate MakeEstimate() {
  OdometryEstimate estimate;
  estimate.stamp = Time::FromSeconds(12.0);
  estimate.T_odom_imu = MakePose(RotationFromRpy(0.3, -0.2, 1.1), Eigen::Vector3d(4, -2, 1));
  estimate.velocity_odom = {0.5, -1.0, 0.2};
  estimate.angular_velocity_imu = {0.1, 0.4, -0.3};
  Matrix6d root;
  for (int i = 0; i < 36; ++i) root(i / 6, i % 6) = std::sin(1.0 + i);
  estimate.pose_covariance = 1e-4 * root * root.transpose();
  estimate.twist_covariance = 1e-3 * root.transpose() * root;
  return estimate;
}

Pose MakeLever() {
  return MakePose(RotationFromRpy(0.0, 0.1, -0.7), Eigen::Vector3d(0.2, -0.1, 0.4));
}

TEST(BodyEstimate, IdentityLeverChangesNothing) {
  const OdometryEstimate estimate = MakeEstimate();
  const BodyEstimate body = MoveToBody(estimate, Pose::Identity());
  EXPECT_TRUE(body.T_odom_body.isApprox(estimate.T_odom_imu, 1e-12));
  EXPECT_TRUE(body.pose_covariance.isApprox(estimate.pose_covariance, 1e-12));
  EXPECT_TRUE(body.twist_covariance.isApprox(estimate.twist_covariance, 1e-12));
}

TEST(BodyEstimate, TwistIsTheDerivativeOfThePose) {
  const OdometryEstimate estimate = MakeEstimate();
  const BodyEstimate body = MoveToBody(estimate, MakeLever());
  OdometryEstimate later = estimate;
  const double dt = 1e-6;
  later.T_odom_imu =
      MakePose(estimate.T_odom_imu.linear() * so3::Exp(estimate.angular_velocity_imu * dt),
               estimate.T_odom_imu.translation() + estimate.velocity_odom * dt);
  const Pose moved = MoveToBody(later, MakeLever()).T_odom_body;
  const Eigen::Vector3d linear = body.T_odom_body.linear().transpose() *
                                 (moved.translation() - body.T_odom_body.translation()) / dt;
  const Eigen::Vector3d angular =
      so3::Log(body.T_odom_body.linear().transpose() * moved.linear()) / dt;
  EXPECT_LT((body.twist.head<3>() - linear).norm(), 1e-5);
  EXPECT_LT((body.twist.tail<3>() - angular).norm(), 1e-5);
}

TEST(BodyEstimate, PoseCovarianceFollowsTheNumericJacobian) {
  const OdometryEstimate estimate = MakeEstimate();
  const Pose body = MoveToBody(estimate, MakeLever()).T_odom_body;
  Matrix6d jacobian;
  const double step = 1e-6;
  for (int i = 0; i < 6; ++i) {
    Vector6d delta = Vector6d::Zero();
    delta[i] = step;
    OdometryEstimate moved = estimate;
    moved.T_odom_imu = MakePose(so3::Exp(delta.tail<3>()) * estimate.T_odom_imu.linear(),
                                estimate.T_odom_imu.translation() + delta.head<3>());
    const Pose other = MoveToBody(moved, MakeLever()).T_odom_body;
    jacobian.col(i) << (other.translation() - body.translation()) / step,
        so3::Log(other.linear() * body.linear().transpose()) / step;
  }
  const Matrix6d expected = jacobian * estimate.pose_covariance * jacobian.transpose();
  const Matrix6d actual = MoveToBody(estimate, MakeLever()).pose_covariance;
  EXPECT_TRUE(actual.isApprox(expected, 1e-4));
  EXPECT_EQ(actual, Matrix6d(actual.transpose()));
}

}  // namespace
}  // namespace hv::lio
