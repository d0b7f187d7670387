#include "hv_core/se3.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "hv_core/so3.h"

namespace hv {
namespace {

/// Tangent vectors with rotations of zero, tiny, random and almost-pi length and translations from
/// zero to 10 m.
std::vector<Vector6d> TangentVectors() {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  std::vector<Vector6d> vectors = {Vector6d::Zero()};
  for (const double angle : {0.0, 1e-12, 1e-8, 9.9e-5, 1.01e-4, 1e-3, 9.9e-3, 1.01e-2, 0.1, 1.0,
                             2.5, M_PI - 1e-3, M_PI - 1e-6}) {
    for (const double length : {0.0, 1e-9, 1.0, 10.0}) {
      Vector6d xi;
      for (int k = 0; k < 6; ++k) xi[k] = normal(random);
      xi.head<3>() *= length / xi.head<3>().norm();
      xi.tail<3>() *= angle / xi.tail<3>().norm();
      vectors.push_back(xi);
    }
  }
  return vectors;
}

TEST(Se3, ExpOfPureTranslationAndPureRotation) {
  Vector6d xi;
  xi << 1.0, 2.0, 3.0, 0.0, 0.0, 0.0;
  EXPECT_TRUE(se3::Exp(xi).linear().isIdentity(1e-15));
  EXPECT_EQ(se3::Exp(xi).translation(), xi.head<3>());
  xi << 0.0, 0.0, 0.0, 0.0, 0.0, 0.5;
  EXPECT_LT((se3::Exp(xi).linear() - RotationFromRpy(0.0, 0.0, 0.5)).norm(), 1e-14);
  EXPECT_EQ(se3::Exp(xi).translation().norm(), 0.0);
}

TEST(Se3, ExpIsTheLimitOfSmallSteps) {
  Vector6d xi;
  xi << 1.0, -0.5, 0.25, 0.3, -0.8, 0.4;
  const Pose step = se3::Exp(xi / 1024.0);
  Pose product = step;
  for (int i = 0; i < 10; ++i) product = product * product;
  EXPECT_LT((product.matrix() - se3::Exp(xi).matrix()).norm(), 1e-11);
}

TEST(Se3, LogInvertsExp) {
  for (const Vector6d& xi : TangentVectors()) {
    EXPECT_LT((se3::Log(se3::Exp(xi)) - xi).norm(), 1e-13 + 1e-8 * xi.norm()) << xi.transpose();
  }
}

TEST(Se3, AdjointMovesPerturbationsAcross) {
  const std::vector<Vector6d> vectors = TangentVectors();
  for (std::size_t i = 1; i < vectors.size(); ++i) {
    const Pose pose = se3::Exp(vectors[i]);
    const Vector6d xi = 0.1 * vectors[(i * 7) % vectors.size()];
    const Pose left = pose * se3::Exp(xi) * pose.inverse();
    const Pose right = se3::Exp(se3::Adjoint(pose) * xi);
    EXPECT_LT((left.matrix() - right.matrix()).norm(), 1e-9);
  }
}

/// Central difference of d -> Log(Exp(xi)^-1 Exp(xi + d)).
Matrix6d NumericPoseJacobian(const Vector6d& xi) {
  constexpr double kStep = 1e-5;
  const Pose inverse = se3::Exp(xi).inverse();
  Matrix6d jacobian;
  for (int k = 0; k < 6; ++k) {
    Vector6d d = Vector6d::Zero();
    d[k] = kStep;
    const Vector6d ahead = se3::Log(inverse * se3::Exp(xi + d));
    const Vector6d behind = se3::Log(inverse * se3::Exp(xi - d));
    jacobian.col(k) = (ahead - behind) / (2.0 * kStep);
  }
  return jacobian;
}

TEST(Se3, RightJacobianAgreesWithNumericOne) {
  for (const Vector6d& xi : TangentVectors()) {
    EXPECT_LT((se3::RightJacobian(xi) - NumericPoseJacobian(xi)).norm(), 2e-8) << xi.transpose();
  }
}

TEST(Se3, LeftJacobianIsAdjointTimesRightJacobian) {
  for (const Vector6d& xi : TangentVectors()) {
    const Matrix6d expected = se3::Adjoint(se3::Exp(xi)) * se3::RightJacobian(xi);
    EXPECT_LT((se3::LeftJacobian(xi) - expected).norm(), 2e-7) << xi.transpose();
  }
}

TEST(Se3, JacobianInversesInvert) {
  const Matrix6d identity = Matrix6d::Identity();
  for (const Vector6d& xi : TangentVectors()) {
    EXPECT_LT((se3::RightJacobian(xi) * se3::RightJacobianInverse(xi) - identity).norm(), 1e-7);
    EXPECT_LT((se3::LeftJacobian(xi) * se3::LeftJacobianInverse(xi) - identity).norm(), 1e-7);
  }
}

TEST(Se3, MakePoseNormalisesQuaternions) {
  const Eigen::Quaterniond rotation(2.0, 0.0, 0.0, 2.0);
  const Pose pose = MakePose(rotation, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_LT((pose.linear() - RotationFromRpy(0.0, 0.0, M_PI / 2.0)).norm(), 1e-14);
}

TEST(Se3, RotationFromRpyOrdersYawPitchRoll) {
  const Eigen::Matrix3d expected = so3::Exp(Eigen::Vector3d(0.0, 0.0, 0.3)) *
                                   so3::Exp(Eigen::Vector3d(0.0, 0.2, 0.0)) *
                                   so3::Exp(Eigen::Vector3d(0.1, 0.0, 0.0));
  EXPECT_LT((RotationFromRpy(0.1, 0.2, 0.3) - expected).norm(), 1e-14);
}

TEST(Se3, RotationDistanceIsTheAngle) {
  for (const double angle : {0.0, 1e-7, 0.5, 3.0, M_PI}) {
    const Pose a = MakePose(RotationFromRpy(0.4, -0.2, 1.0), Eigen::Vector3d::Zero());
    const Pose b = a * Eigen::AngleAxisd(angle, Eigen::Vector3d(1.0, 2.0, 3.0).normalized());
    EXPECT_NEAR(RotationDistance(a, b), angle, 1e-9);
  }
}

}  // namespace
}  // namespace hv
