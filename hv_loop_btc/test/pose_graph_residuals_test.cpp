#include "hv_loop_btc/pose_graph_residuals.h"

#include <gtest/gtest.h>

#include "numeric_jacobian.h"

namespace hv::loop {
namespace {

const Pose kFrom = MakePose(RotationFromRpy(0.3, -0.2, 2.0), {12.0, -7.0, 1.5});
const Pose kStep = MakePose(RotationFromRpy(0.05, 0.1, -0.8), {2.0, 0.3, -0.1});

TEST(RelativePoseResidual, IsTheErrorOfTheSecondPose) {
  for (const Vector6d& error : SampleTangents(1)) {
    const Pose to = kFrom * kStep * se3::Exp(error);
    EXPECT_LT((RelativePoseResidual(kStep, kFrom, to) - error).norm(), 1e-12);
  }
}

TEST(RelativePoseResidual, JacobiansMatchDifferences) {
  for (const Vector6d& error : SampleTangents(2)) {
    const Pose to = kFrom * kStep * se3::Exp(error);
    Matrix6d by_from;
    Matrix6d by_to;
    RelativePoseResidual(kStep, kFrom, to, &by_from, &by_to);
    const auto of_from = [&](const Pose& pose) { return RelativePoseResidual(kStep, pose, to); };
    const auto of_to = [&](const Pose& pose) { return RelativePoseResidual(kStep, kFrom, pose); };
    EXPECT_LT((by_from - NumericJacobian(of_from, kFrom)).cwiseAbs().maxCoeff(), 1e-7);
    EXPECT_LT((by_to - NumericJacobian(of_to, to)).cwiseAbs().maxCoeff(), 1e-7);
  }
}

TEST(TiltResidual, IsTheTiltOfThePoseWhateverYawAndPosition) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  EXPECT_LT(TiltResidual(up, MakePose(RotationFromRpy(0, 0, 2.5), {3.0, 4.0, 5.0})).norm(), 1e-15);
  const Pose tilted = MakePose(RotationFromRpy(0.01, 0.0, 2.5), {3.0, 4.0, 5.0});
  EXPECT_NEAR(TiltResidual(up, tilted).norm(), 0.01, 1e-6);
}

TEST(TiltResidual, JacobianMatchesDifferences) {
  const Eigen::Vector3d up = Eigen::Vector3d(0.1, -0.2, 1.0).normalized();
  for (const Vector6d& tangent : SampleTangents(3)) {
    const Pose pose = kFrom * se3::Exp(tangent);
    TiltJacobian by_pose;
    TiltResidual(up, pose, &by_pose);
    const auto of_pose = [&](const Pose& moved) { return TiltResidual(up, moved); };
    EXPECT_LT((by_pose - NumericJacobian(of_pose, pose)).cwiseAbs().maxCoeff(), 1e-9);
  }
}

}  // namespace
}  // namespace hv::loop
