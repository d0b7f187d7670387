#include "hv_lio/imu_propagation.h"

#include <random>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "hv_core/so3.h"
#include "random_state.h"

namespace hv::lio {
namespace {

ImuStep RandomStep(std::mt19937& random, double dt) {
  ImuStep step;
  step.angular_velocity = RandomVector(random, 1.5);
  step.acceleration = RandomVector(random, 8.0);
  step.dt = dt;
  return step;
}

NavState Propagated(const ImuStep& step, NavState state) {
  PropagateState(step, state);
  return state;
}

/// Compares the analytic Jacobian with central differences.
void CheckJacobian(const ImuStep& step, const NavState& state) {
  const ErrorMatrix jacobian = PropagationJacobian(step, state);
  const NavState nominal = Propagated(step, state);
  for (int column = 0; column < kErrorDim; ++column) {
    const ErrorVector delta = 1e-5 * ErrorVector::Unit(column);
    const ErrorVector numeric = (Propagated(step, state.Plus(delta)).Minus(nominal) -
                                 Propagated(step, state.Plus(-delta)).Minus(nominal)) /
                                2e-5;
    EXPECT_LT((jacobian.col(column) - numeric).norm(), 2e-6) << "column " << column;
  }
}

class PropagationTest : public ::testing::TestWithParam<double> {};

TEST_P(PropagationTest, JacobianMatchesDifferences) {
  std::mt19937 random(1);
  for (int i = 0; i < 20; ++i) {
    const NavState state = RandomState(random);
    const ImuStep step = RandomStep(random, GetParam());
    CheckJacobian(step, state);
  }
}

INSTANTIATE_TEST_SUITE_P(Intervals, PropagationTest, ::testing::Values(1e-6, 0.0025, 0.02, 0.1));

TEST(PropagationTest, AtRestStaysAtRest) {
  NavState state;
  ImuStep step;
  step.acceleration = Eigen::Vector3d(0.0, 0.0, 9.80665);
  step.dt = 0.0025;
  for (int i = 0; i < 4000; ++i) PropagateState(step, state);
  EXPECT_LT(state.position.norm(), 1e-9);
  EXPECT_LT(state.velocity.norm(), 1e-9);
}

TEST(PropagationTest, ConstantTurnAndForceAreIntegratedExactly) {
  NavState state;
  state.gravity.setZero();
  ImuStep step;
  step.angular_velocity = Eigen::Vector3d(0.0, 0.0, 0.5);
  step.dt = 0.001;
  for (int i = 0; i < 2000; ++i) PropagateState(step, state);
  EXPECT_LT(so3::Log(RotationFromRpy(0, 0, 1.0).transpose() * state.rotation).norm(), 1e-9);
}

TEST(PropagationTest, KnotReproducesThePropagatedPose) {
  std::mt19937 random(4);
  NavState state = RandomState(random);
  const ImuStep step = RandomStep(random, 0.01);
  const MotionKnot knot = PropagateState(step, state);
  const Pose end = knot.PoseAfter(step.dt);
  EXPECT_LT((end.translation() - state.position).norm(), 1e-12);
  EXPECT_LT((end.linear() - state.rotation).norm(), 1e-12);
}

TEST(PropagationTest, CovarianceStaysSymmetricPositiveAndGrows) {
  std::mt19937 random(5);
  NavState state = RandomState(random);
  ErrorMatrix covariance = 1e-4 * ErrorMatrix::Identity();
  const double before = covariance.trace();
  for (int i = 0; i < 500; ++i) {
    const ImuStep step = RandomStep(random, 0.0025);
    PropagateCovariance(step, state, ImuNoiseConfig(), covariance);
    PropagateState(step, state);
  }
  EXPECT_EQ((covariance - covariance.transpose()).norm(), 0.0);
  EXPECT_EQ(covariance.llt().info(), Eigen::Success);
  EXPECT_GT(covariance.trace(), before);
}

TEST(PropagationTest, JacobianOfAMissingReadingMatchesDifferences) {
  std::mt19937 random(6);
  const NavState state = RandomState(random);
  ImuStep step = RandomStep(random, 0.02);
  step.quality = ImuQuality::kMissing;
  CheckJacobian(step, state);
}

TEST(PropagationTest, SaturatedReadingsAreTrustedLessAndMissingOnesLeast) {
  NavState state;
  ImuStep step;
  step.dt = 0.01;
  ErrorMatrix sure = 1e-6 * ErrorMatrix::Identity();
  ErrorMatrix unsure = sure;
  ErrorMatrix blind = sure;
  PropagateCovariance(step, state, ImuNoiseConfig(), sure);
  step.quality = ImuQuality::kSaturated;
  PropagateCovariance(step, state, ImuNoiseConfig(), unsure);
  step.quality = ImuQuality::kMissing;
  PropagateCovariance(step, state, ImuNoiseConfig(), blind);
  const int v = ErrorIndex::kVelocity;
  EXPECT_GT(unsure(v, v), 10.0 * (sure(v, v) - 1e-6) + 1e-6);
  EXPECT_GT(blind(v, v), 10.0 * unsure(v, v));
}

}  // namespace
}  // namespace hv::lio
