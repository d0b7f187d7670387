#include "hv_lio/residual.h"

#include <random>

#include <gtest/gtest.h>

#include "random_state.h"

namespace hv::lio {
namespace {

SurfaceFeature RandomFeature(std::mt19937& random, SurfaceFeature::Kind kind) {
  SurfaceFeature feature;
  feature.kind = kind;
  feature.center = RandomVector(random, 3.0);
  feature.axes = so3::Exp(RandomVector(random, 1.0));
  feature.variance = Eigen::Vector3d(0.1, 0.02, 1e-4);
  feature.offset_variance = 1e-5;
  return feature;
}

SurfaceCell RandomCell(std::mt19937& random) {
  SurfaceCell cell;
  cell.mean = RandomVector(random, 10.0);
  cell.noise = 1e-4 * Eigen::Matrix3d::Identity();
  cell.scatter = 1e-3 * Eigen::Matrix3d::Identity();
  cell.count = 5.0;
  return cell;
}

/// Compares the analytic Jacobian with central differences of the value.
template <typename Evaluate>
void CheckJacobian(const NavState& state, const Evaluate& evaluate) {
  const Residual residual = evaluate(state.T_odom_imu());
  for (int column = 0; column < 6; ++column) {
    const ErrorVector delta = 1e-6 * ErrorVector::Unit(column);
    const double numeric = (evaluate(state.Plus(delta).T_odom_imu()).value -
                            evaluate(state.Plus(-delta).T_odom_imu()).value) /
                           2e-6;
    EXPECT_NEAR(residual.jacobian[column], numeric, 1e-6) << "column " << column;
  }
}

TEST(ResidualTest, PlaneJacobianMatchesDifferences) {
  std::mt19937 random(1);
  for (int i = 0; i < 50; ++i) {
    const SurfaceFeature plane = RandomFeature(random, SurfaceFeature::Kind::kPlane);
    const SurfaceCell cell = RandomCell(random);
    CheckJacobian(RandomState(random),
                  [&](const Pose& pose) { return PlaneResidual(cell, plane, pose); });
  }
}

TEST(ResidualTest, GaussianJacobianMatchesDifferencesOnEveryAxis) {
  std::mt19937 random(2);
  for (int axis = 0; axis < 3; ++axis) {
    const SurfaceFeature gaussian = RandomFeature(random, SurfaceFeature::Kind::kGaussian);
    const SurfaceCell cell = RandomCell(random);
    CheckJacobian(RandomState(random),
                  [&](const Pose& pose) { return GaussianResidual(cell, gaussian, axis, pose); });
  }
}

TEST(ResidualTest, PointOnThePlaneHasNoResidual) {
  std::mt19937 random(3);
  const NavState state = RandomState(random);
  const SurfaceFeature plane = RandomFeature(random, SurfaceFeature::Kind::kPlane);
  SurfaceCell cell = RandomCell(random);
  const Eigen::Vector3d on_plane = plane.center + 0.7 * plane.axes.col(0) - 2.0 * plane.axes.col(1);
  cell.mean = state.T_odom_imu().inverse() * on_plane;
  EXPECT_NEAR(PlaneResidual(cell, plane, state.T_odom_imu()).value, 0.0, 1e-12);
}

TEST(ResidualTest, VarianceGrowsAwayFromTheCentreAndShrinksWithPoints) {
  std::mt19937 random(4);
  const SurfaceFeature plane = RandomFeature(random, SurfaceFeature::Kind::kPlane);
  SurfaceCell cell = RandomCell(random);
  cell.mean = plane.center;
  const double near = PlaneResidual(cell, plane, Pose::Identity()).variance;
  SurfaceCell dense = cell;
  dense.count = 50.0;
  EXPECT_LT(PlaneResidual(dense, plane, Pose::Identity()).variance, near);
  cell.mean = plane.center + 5.0 * plane.axes.col(1);
  EXPECT_GT(PlaneResidual(cell, plane, Pose::Identity()).variance, near);
}

}  // namespace
}  // namespace hv::lio
