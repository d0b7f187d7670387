#include "graph_solver.h"

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "numeric_jacobian.h"
#include "uncertain_pose.h"

namespace hv::loop {
namespace {

using RowMajor67 = Eigen::Matrix<double, 6, 7, Eigen::RowMajor>;
using RowMajor27 = Eigen::Matrix<double, 2, 7, Eigen::RowMajor>;

const Pose kPose = MakePose(RotationFromRpy(0.3, -0.2, 2.0), {12.0, -7.0, 1.5});

Matrix6d SampleInformation(int rank) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd factor(6, rank);
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < rank; ++k) factor(i, k) = normal(random);
  }
  return factor * factor.transpose();
}

TEST(PoseManifold, PlusIsTheRightPerturbation) {
  const PoseManifold manifold;
  for (const Vector6d& tangent : SampleTangents(1)) {
    PoseBlock moved;
    manifold.Plus(ToBlock(kPose).data(), tangent.data(), moved.data());
    const Pose expected = kPose * se3::Exp(tangent);
    EXPECT_LT((FromBlock(moved.data()).matrix() - expected.matrix()).norm(), 1e-13);
  }
}

TEST(PoseManifold, MinusInvertsPlus) {
  const PoseManifold manifold;
  const PoseBlock block = ToBlock(kPose);
  for (const Vector6d& tangent : SampleTangents(2)) {
    PoseBlock moved;
    Vector6d difference;
    manifold.Plus(block.data(), tangent.data(), moved.data());
    manifold.Minus(moved.data(), block.data(), difference.data());
    EXPECT_LT((difference - tangent).norm(), 1e-13);
  }
}

TEST(PoseManifold, JacobiansOfPlusAndMinusAreInverse) {
  const PoseManifold manifold;
  const PoseBlock block = ToBlock(kPose);
  Eigen::Matrix<double, 7, 6, Eigen::RowMajor> plus;
  RowMajor67 minus;
  manifold.PlusJacobian(block.data(), plus.data());
  manifold.MinusJacobian(block.data(), minus.data());
  EXPECT_TRUE((minus * plus).isIdentity());
}

TEST(RelativePoseCost, JacobiansMatchDifferencesAlongTheManifold) {
  const Pose step = MakePose(RotationFromRpy(0.05, 0.1, -0.8), {2.0, 0.3, -0.1});
  const RelativePoseCost cost(step, SquareRoot(SampleInformation(6)));
  for (const Vector6d& error : SampleTangents(4)) {
    const Pose to = kPose * step * se3::Exp(error);
    const auto evaluate = [&](const Pose& from_pose, const Pose& to_pose) {
      const PoseBlock blocks[2] = {ToBlock(from_pose), ToBlock(to_pose)};
      const double* parameters[2] = {blocks[0].data(), blocks[1].data()};
      Vector6d residual;
      cost.Evaluate(parameters, residual.data(), nullptr);
      return residual;
    };
    const PoseBlock blocks[2] = {ToBlock(kPose), ToBlock(to)};
    const double* parameters[2] = {blocks[0].data(), blocks[1].data()};
    Vector6d residual;
    RowMajor67 by_from;
    RowMajor67 by_to;
    double* jacobians[2] = {by_from.data(), by_to.data()};
    cost.Evaluate(parameters, residual.data(), jacobians);
    EXPECT_LT((residual - evaluate(kPose, to)).norm(), 1e-12);
    const auto of_from = [&](const Pose& pose) { return evaluate(pose, to); };
    const auto of_to = [&](const Pose& pose) { return evaluate(kPose, pose); };
    EXPECT_LT((by_from.leftCols<6>() - NumericJacobian(of_from, kPose)).norm(), 1e-6);
    EXPECT_LT((by_to.leftCols<6>() - NumericJacobian(of_to, to)).norm(), 1e-6);
    EXPECT_EQ(by_from.col(6).norm() + by_to.col(6).norm(), 0.0);
  }
}

TEST(TiltCost, JacobianMatchesDifferencesAlongTheManifold) {
  const TiltCost cost(Eigen::Vector3d(0.1, -0.2, 1.0).normalized(), 0.01);
  const auto evaluate = [&](const Pose& pose) {
    const PoseBlock block = ToBlock(pose);
    const double* parameters[1] = {block.data()};
    Eigen::Vector2d residual;
    cost.Evaluate(parameters, residual.data(), nullptr);
    return residual;
  };
  const PoseBlock block = ToBlock(kPose);
  const double* parameters[1] = {block.data()};
  Eigen::Vector2d residual;
  RowMajor27 jacobian;
  double* jacobians[1] = {jacobian.data()};
  cost.Evaluate(parameters, residual.data(), jacobians);
  EXPECT_LT((jacobian.leftCols<6>() - NumericJacobian(evaluate, kPose)).norm(), 1e-6);
}

TEST(SquareRoot, HoldsForSingularMatricesToo) {
  for (const int rank : {6, 4, 1}) {
    const Matrix6d information = SampleInformation(rank);
    const Matrix6d root = SquareRoot(information);
    EXPECT_LT((root.transpose() * root - information).norm(), 1e-12 * information.norm()) << rank;
  }
}

TEST(InverseOf, InvertsAndStaysFiniteForSingularMatrices) {
  const Matrix6d information = SampleInformation(6);
  EXPECT_TRUE((InverseOf(information) * information).isIdentity(1e-8));
  EXPECT_TRUE(InverseOf(SampleInformation(3)).allFinite());
}

TEST(ChiSquareQuantile6, MatchesTables) {
  EXPECT_NEAR(ChiSquareQuantile6(0.5), 5.348, 1e-3);
  EXPECT_NEAR(ChiSquareQuantile6(0.95), 12.592, 1e-3);
  EXPECT_NEAR(ChiSquareQuantile6(0.999), 22.458, 1e-3);
}

TEST(GraphSolver, HoldsTheFirstPoseOfEachPart) {
  const Pose step = MakePose(RotationFromRpy(0.0, 0.0, 0.1), {1.0, 0.0, 0.0});
  const std::vector<Pose> guesses(5, kPose);
  GraphSolver solver(guesses);
  solver.AddConstraint({0, 1, step, Matrix6d::Identity()});
  solver.AddConstraint({2, 4, step, Matrix6d::Identity()});
  solver.AddConstraint({1, 2, step, Matrix6d::Identity()}, 0.0);
  EXPECT_TRUE(solver.Solve(20, 1e-12).converged);
  const std::vector<Pose> poses = solver.Poses();
  for (const std::size_t held : {0, 2, 3}) {
    EXPECT_LT((poses[held].matrix() - kPose.matrix()).norm(), 1e-12) << held;
  }
  for (const std::size_t moved : {1, 4}) {
    EXPECT_LT((poses[moved].matrix() - (kPose * step).matrix()).norm(), 1e-9) << moved;
  }
}

}  // namespace
}  // namespace hv::loop
