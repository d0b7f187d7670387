#include "hv_loop_btc/odometry_edge.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "hv_core/so3.h"
#include "numeric_jacobian.h"

namespace hv::loop {
namespace {

Matrix6d SampleCovariance(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Matrix6d factor;
  for (int i = 0; i < 36; ++i) factor(i) = 0.01 * normal(random);
  return factor * factor.transpose();
}

Keyframe MakeKeyframe(std::uint32_t id, const Pose& T_odom_imu) {
  Keyframe keyframe;
  keyframe.id = id;
  keyframe.T_odom_imu = T_odom_imu;
  keyframe.covariance = 1e-4 * Matrix6d::Identity();
  return keyframe;
}

const Keyframe kFromKeyframe =
    MakeKeyframe(4, MakePose(RotationFromRpy(0.1, -0.2, 1.0), {10.0, 5.0, 1.0}));
const Keyframe kTo = MakeKeyframe(5, MakePose(RotationFromRpy(0.2, -0.1, 1.7), {11.0, 6.0, 1.1}));

Eigen::Vector3d TranslationVariances(const GraphEdge& edge) {
  return edge.information.inverse().diagonal().head<3>();
}

/// Variance of the edge along a unit direction of odom; translation or rotation.
double VarianceAlong(const GraphEdge& edge, const Eigen::Vector3d& direction_odom, bool rotation) {
  const Matrix6d covariance = edge.information.inverse();
  const Eigen::Vector3d direction = kTo.T_odom_imu.linear().transpose() * direction_odom;
  const Eigen::Matrix3d block = rotation ? Eigen::Matrix3d(covariance.bottomRightCorner<3, 3>())
                                         : Eigen::Matrix3d(covariance.topLeftCorner<3, 3>());
  return direction.dot(block * direction);
}

TEST(RightCovariance, IsThatOfTheRightPerturbation) {
  Keyframe keyframe = kFromKeyframe;
  keyframe.covariance = SampleCovariance(1);
  // The keyframe's error: position added, rotation multiplied from the left, both in axes of odom.
  const auto error_in_odom = [&](const Pose& moved) {
    Eigen::VectorXd error(6);
    error << moved.translation() - kFromKeyframe.T_odom_imu.translation(),
        so3::Log(moved.linear() * kFromKeyframe.T_odom_imu.linear().transpose());
    return error;
  };
  const Matrix6d odom_by_right = NumericJacobian(error_in_odom, keyframe.T_odom_imu);
  const Matrix6d back = odom_by_right * RightCovariance(keyframe) * odom_by_right.transpose();
  EXPECT_LT((back - keyframe.covariance).norm(), 1e-7 * keyframe.covariance.norm());
}

TEST(RelativeCovariance, WithoutCorrelationPropagatesBothPoses) {
  const Pose T_from_to = kFromKeyframe.T_odom_imu.inverse() * kTo.T_odom_imu;
  const auto error = [&](const Pose& from, const Pose& to) {
    return Eigen::VectorXd(se3::Log(T_from_to.inverse() * from.inverse() * to));
  };
  const Matrix6d by_from = NumericJacobian(
      [&](const Pose& pose) { return error(pose, kTo.T_odom_imu); }, kFromKeyframe.T_odom_imu);
  const Matrix6d by_to = NumericJacobian(
      [&](const Pose& pose) { return error(kFromKeyframe.T_odom_imu, pose); }, kTo.T_odom_imu);
  const Matrix6d expected = by_from * SampleCovariance(2) * by_from.transpose() +
                            by_to * SampleCovariance(3) * by_to.transpose();
  const Matrix6d covariance =
      RelativeCovariance(T_from_to, SampleCovariance(2), SampleCovariance(3), 0.0);
  EXPECT_LT((covariance - expected).norm(), 1e-6 * expected.norm());
}

TEST(RelativeCovariance, WithFullCorrelationOnlyGrowthCounts) {
  const Matrix6d before = SampleCovariance(4);
  const Matrix6d growth = SampleCovariance(5);
  const Pose T_from_to = kFromKeyframe.T_odom_imu.inverse() * kTo.T_odom_imu;
  const Matrix6d adjoint = se3::Adjoint(T_from_to.inverse());
  const Matrix6d after = adjoint * before * adjoint.transpose() + growth;
  EXPECT_LT((RelativeCovariance(T_from_to, before, after, 1.0) - growth).norm(),
            1e-9 * growth.norm());
}

TEST(OdometryEdge, MeasuresTheStepBetweenKeyframes) {
  const GraphEdge edge = OdometryEdge(OdometryEdgeConfig(), kFromKeyframe, kTo);
  EXPECT_EQ(edge.kind, EdgeKind::kOdometry);
  EXPECT_EQ(edge.from, 4U);
  EXPECT_EQ(edge.to, 5U);
  const Pose to = kFromKeyframe.T_odom_imu * edge.T_from_to;
  EXPECT_LT((to.matrix() - kTo.T_odom_imu.matrix()).norm(), 1e-12);
  EXPECT_EQ(edge.information, edge.information.transpose());
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix6d>(edge.information).eigenvalues().minCoeff(),
            0.0);
}

TEST(OdometryEdge, PerfectPosesStillDrift) {
  const OdometryEdgeConfig config;
  Keyframe from = kFromKeyframe;
  Keyframe to = kTo;
  from.covariance.setZero();
  to.covariance.setZero();
  const double distance = (from.T_odom_imu.inverse() * to.T_odom_imu).translation().norm();
  const double expected =
      std::pow(config.translation_sigma_m, 2) + std::pow(config.translation_drift_m, 2) * distance;
  const Eigen::Vector3d variances = TranslationVariances(OdometryEdge(config, from, to));
  EXPECT_LT((variances.array() - expected).abs().maxCoeff(), 1e-9);
}

TEST(OdometryEdge, VarianceGrowsWithTheDistance) {
  const Keyframe far =
      MakeKeyframe(5, kFromKeyframe.T_odom_imu * Eigen::Translation3d(30.0, 0.0, 0.0));
  const Keyframe near =
      MakeKeyframe(5, kFromKeyframe.T_odom_imu * Eigen::Translation3d(0.1, 0.0, 0.0));
  const OdometryEdgeConfig config;
  EXPECT_GT(TranslationVariances(OdometryEdge(config, kFromKeyframe, far)).x(),
            2.0 * TranslationVariances(OdometryEdge(config, kFromKeyframe, near)).x());
}

TEST(OdometryEdge, DegenerateDirectionsAreInflatedAndOthersAreNot) {
  const OdometryEdgeConfig config;
  const Eigen::Vector3d along = Eigen::Vector3d(1.0, 2.0, 0.0).normalized();
  const Eigen::Vector3d across = Eigen::Vector3d(2.0, -1.0, 0.0).normalized();
  const GraphEdge plain = OdometryEdge(config, kFromKeyframe, kTo);
  Keyframe from = kFromKeyframe;
  Keyframe to = kTo;
  for (Keyframe* keyframe : {&from, &to}) {
    keyframe->degenerate_translation = {along};
    keyframe->degenerate_rotation = {keyframe->T_odom_imu.linear().transpose() * along};
  }
  const GraphEdge degenerate = OdometryEdge(config, from, to);
  const double translation = std::pow(config.degenerate_translation_m, 2);
  const double rotation = std::pow(config.degenerate_rotation_deg * M_PI / 180.0, 2);
  for (const bool turn : {false, true}) {
    const double inflation =
        VarianceAlong(degenerate, along, turn) - VarianceAlong(plain, along, turn);
    EXPECT_NEAR(inflation, turn ? rotation : translation, 1e-9);
    EXPECT_NEAR(VarianceAlong(degenerate, across, turn), VarianceAlong(plain, across, turn), 1e-9);
  }
}

TEST(OdometryEdge, RefusesKeyframesOfDifferentSegments) {
  Keyframe to = kTo;
  to.segment = 1;
  EXPECT_THROW(OdometryEdge(OdometryEdgeConfig(), kFromKeyframe, to), InputError);
}

TEST(UpInImu, PointsUpAtTheKeyframe) {
  const Eigen::Vector3d up_odom = kFromKeyframe.T_odom_imu.linear() * UpInImu(kFromKeyframe);
  EXPECT_LT((up_odom - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
}

TEST(OdometryEdgeConfig, DefaultsAreValidAndMistakesAreNamed) {
  ConfigProblems none;
  OdometryEdgeConfig().Validate(none);
  EXPECT_TRUE(none.lines().empty());
  OdometryEdgeConfig wrong;
  wrong.correlation = 1.5;
  wrong.translation_sigma_m = 0.0;
  ConfigProblems problems;
  wrong.Validate(problems);
  EXPECT_EQ(problems.lines().size(), 2U);
}

}  // namespace
}  // namespace hv::loop
