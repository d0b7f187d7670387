#include "hv_core/pose_covariance.h"

#include <cmath>

#include <gtest/gtest.h>

namespace hv {
namespace {

Matrix6d Example() {
  Matrix6d root;
  for (int i = 0; i < 36; ++i) root(i / 6, i % 6) = std::sin(1.0 + i);
  return 1e-6 * (root * root.transpose() + Matrix6d::Identity());
}

/// The difference of two poses in axes of the map.
Vector6d Difference(const Pose& from, const Pose& to) {
  const Eigen::AngleAxisd turn(to.linear() * from.linear().transpose());
  Vector6d difference;
  difference << to.translation() - from.translation(), turn.angle() * turn.axis();
  return difference;
}

TEST(PoseCovarianceTest, IsThatOfPerturbedPosesInAxesOfTheMap) {
  const Pose T_map_imu = MakePose(RotationFromRpy(0.2, -0.4, 2.0), Eigen::Vector3d(40, -7, 2));
  const Pose T_imu_base = MakePose(RotationFromRpy(0.0, 0.1, -1.2), Eigen::Vector3d(-0.3, 0.1, -1));
  const Matrix6d covariance = Example();
  const Matrix6d root = covariance.llt().matrixL();
  Matrix6d expected = Matrix6d::Zero();
  for (int i = 0; i < 6; ++i) {
    const Vector6d step = root.col(i);
    const Vector6d moved =
        Difference(T_map_imu * T_imu_base, T_map_imu * se3::Exp(step) * T_imu_base);
    expected += moved * moved.transpose();
  }
  const Matrix6d actual = CovarianceInMapAxes(T_map_imu, covariance, T_imu_base);
  EXPECT_LT((actual - expected).cwiseAbs().maxCoeff(), 1e-2 * expected.cwiseAbs().maxCoeff());
  EXPECT_EQ((actual - actual.transpose()).cwiseAbs().maxCoeff(), 0.0);
}

TEST(PoseCovarianceTest, TurnsUncertaintyAlongTheRobotIntoTheMap) {
  Matrix6d along = Matrix6d::Zero();
  along(0, 0) = 0.04;
  const Pose facing_y = MakePose(RotationFromRpy(0.0, 0.0, M_PI / 2.0), Eigen::Vector3d(1, 2, 3));
  const Matrix6d covariance = CovarianceInMapAxes(facing_y, along, Pose::Identity());
  EXPECT_NEAR(covariance(0, 0), 0.0, 1e-12);
  EXPECT_NEAR(covariance(1, 1), 0.04, 1e-12);
}

TEST(PoseCovarianceTest, WeakestDirectionOfATurnedEllipsoid) {
  const Eigen::Matrix3d turn = RotationFromRpy(0.3, -0.2, 1.1);
  const Eigen::Vector3d variances(0.01, 0.25, 0.0004);
  Matrix6d covariance = Matrix6d::Identity();
  covariance.topLeftCorner<3, 3>() = turn * variances.asDiagonal() * turn.transpose();
  const WeakestDirection weakest = WeakestDirectionOf(covariance);
  EXPECT_NEAR(weakest.sigma_m, 0.5, 1e-12);
  EXPECT_NEAR(std::abs(weakest.axis.dot(turn.col(1))), 1.0, 1e-12);
}

}  // namespace
}  // namespace hv
