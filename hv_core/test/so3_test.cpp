#include "hv_core/so3.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace hv::so3 {
namespace {

/// Rotation vectors of zero, tiny, series-boundary, random and almost-pi length, in fixed random
/// directions.
std::vector<Eigen::Vector3d> RotationVectors(double longest) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<Eigen::Vector3d> vectors = {Eigen::Vector3d::Zero()};
  for (const double length : {1e-300, 1e-12, 1e-8, 1e-6, 9.9e-5, 1.01e-4, 5e-4, 1e-3, 9e-3, 1.1e-2,
                              0.1, 1.0, 2.0, 3.0, M_PI - 1e-3, M_PI - 1e-6, M_PI - 1e-9}) {
    if (length > longest) continue;
    for (int i = 0; i < 5; ++i) {
      const Eigen::Vector3d direction(normal(random), normal(random), normal(random));
      vectors.push_back(direction.normalized() * length);
    }
  }
  return vectors;
}

TEST(So3, ExpAgreesWithAngleAxis) {
  for (const Eigen::Vector3d& theta : RotationVectors(M_PI)) {
    const Eigen::AngleAxisd expected(theta.norm(), theta.norm() > 0.0
                                                       ? Eigen::Vector3d(theta.normalized())
                                                       : Eigen::Vector3d::UnitX());
    EXPECT_LT((Exp(theta) - expected.toRotationMatrix()).norm(), 1e-14) << theta.transpose();
  }
}

TEST(So3, ExpIsARotation) {
  for (const Eigen::Vector3d& theta : RotationVectors(M_PI)) {
    const Eigen::Matrix3d rotation = Exp(theta);
    EXPECT_LT((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_NEAR(rotation.determinant(), 1.0, 1e-14);
  }
}

TEST(So3, LogInvertsExp) {
  for (const Eigen::Vector3d& theta : RotationVectors(M_PI)) {
    const double tolerance = 1e-14 + 1e-13 * theta.norm();
    EXPECT_LT((Log(Exp(theta)) - theta).norm(), tolerance) << theta.norm();
  }
}

TEST(So3, LogAtPiIsAHalfTurn) {
  for (const Eigen::Vector3d& theta : RotationVectors(M_PI)) {
    if (theta.norm() < 1e-3) continue;
    const Eigen::Vector3d half_turn = theta.normalized() * M_PI;
    const Eigen::Vector3d log = Log(Exp(half_turn));
    EXPECT_NEAR(log.norm(), M_PI, 1e-9);
    EXPECT_LT((Exp(log) - Exp(half_turn)).norm(), 1e-9);
  }
}

TEST(So3, HatIsTheCrossProduct) {
  const Eigen::Vector3d a(1.0, -2.0, 3.0);
  const Eigen::Vector3d b(-0.5, 4.0, 0.25);
  EXPECT_EQ(Hat(a) * b, a.cross(b));
}

/// Central difference of d -> Log(Exp(theta)^-1 Exp(theta + d)).
Eigen::Matrix3d NumericRightJacobian(const Eigen::Vector3d& theta) {
  constexpr double kStep = 1e-5;
  const Eigen::Matrix3d inverse = Exp(theta).transpose();
  Eigen::Matrix3d jacobian;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(k);
    jacobian.col(k) = (Log(inverse * Exp(theta + d)) - Log(inverse * Exp(theta - d))) / (2 * kStep);
  }
  return jacobian;
}

TEST(So3, RightJacobianAgreesWithNumericOne) {
  for (const Eigen::Vector3d& theta : RotationVectors(M_PI)) {
    EXPECT_LT((RightJacobian(theta) - NumericRightJacobian(theta)).norm(), 1e-9) << theta.norm();
  }
}

TEST(So3, LeftJacobianIsExpTimesRightJacobian) {
  for (const Eigen::Vector3d& theta : RotationVectors(M_PI)) {
    EXPECT_LT((LeftJacobian(theta) - Exp(theta) * RightJacobian(theta)).norm(), 1e-8)
        << theta.norm();
  }
}

TEST(So3, JacobianInversesInvert) {
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  for (const Eigen::Vector3d& theta : RotationVectors(M_PI)) {
    EXPECT_LT((RightJacobian(theta) * RightJacobianInverse(theta) - identity).norm(), 1e-8);
    EXPECT_LT((LeftJacobian(theta) * LeftJacobianInverse(theta) - identity).norm(), 1e-8);
  }
}

TEST(So3, NormalizeRepairsAndKeepsRotations) {
  for (const Eigen::Vector3d& theta : RotationVectors(M_PI)) {
    const Eigen::Matrix3d rotation = Exp(theta);
    EXPECT_LT((Normalize(rotation) - rotation).norm(), 1e-14);
    const Eigen::Matrix3d repaired = Normalize(rotation + 1e-3 * Eigen::Matrix3d::Ones());
    EXPECT_LT((repaired * repaired.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_LT((repaired - rotation).norm(), 5e-3);
  }
  const Eigen::Matrix3d mirror = Eigen::Vector3d(1.0, 1.0, -1.0).asDiagonal();
  EXPECT_NEAR(Normalize(mirror).determinant(), 1.0, 1e-14);
}

}  // namespace
}  // namespace hv::so3
