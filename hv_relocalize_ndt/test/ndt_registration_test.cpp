#include "hv_relocalize_ndt/ndt_registration.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>
#include <Eigen/Eigenvalues>

#include "known_hall.h"
#include "surfaces.h"

namespace hv::relocalize {
namespace {

using Points = std::vector<Eigen::Vector3f>;

constexpr double kOutlierShare = 0.55;

Vector6d RandomVector(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> part(-size, size);
  Vector6d vector;
  for (int i = 0; i < 6; ++i) vector[i] = part(random);
  return vector;
}

/// A cube of 8 x 8 x 8 blobs, none of which is a plane.
NdtLevel Blobs(double resolution_m, std::mt19937& random) {
  std::normal_distribution<float> normal;
  const auto size = static_cast<float>(resolution_m);
  Points points;
  for (int cube = 0; cube < 512; ++cube) {
    const Eigen::Vector3f center(static_cast<float>(cube & 7) + 0.5F,
                                 static_cast<float>((cube >> 3) & 7) + 0.5F,
                                 static_cast<float>(cube >> 6) + 0.5F);
    for (int i = 0; i < 12; ++i) {
      const Eigen::Vector3f unit(normal(random), normal(random), normal(random));
      points.push_back(size * (center + Eigen::Vector3f(0.12F, 0.1F, 0.08F).cwiseProduct(unit)));
    }
  }
  return NdtLevel(resolution_m, points);
}

/// Points within three cubes of the origin that `T_target_source` does not bring close to the
/// border of a cube: across it other voxels are looked up, and the cost jumps.
Points AwayFromBorders(const Pose& T_target_source, double resolution_m, std::mt19937& random) {
  constexpr double kMargin = 0.05;
  std::uniform_real_distribution<double> place(-3.0 * resolution_m, 3.0 * resolution_m);
  Points points;
  while (points.size() < 600) {
    const Eigen::Vector3d point(place(random), place(random), place(random));
    const Eigen::Array3d at = (T_target_source * point).array() / resolution_m;
    const Eigen::Array3d inside = at - at.floor();
    if (inside.minCoeff() < kMargin || inside.maxCoeff() > 1.0 - kMargin) continue;
    points.push_back(point.cast<float>());
  }
  return points;
}

/// Central differences. Steps move points by a thousandth of a voxel, of which even the furthest
/// ones from the sensor, five voxels away, stay well within the margin of their cubes.
Vector6d NumericGradient(const NdtLevel& level, const Points& source, const Pose& pose) {
  Vector6d gradient;
  for (int i = 0; i < 6; ++i) {
    const double step = i < 3 ? 1e-3 * level.resolution_m() : 2e-4;
    const Vector6d delta = step * Vector6d::Unit(i);
    const auto cost = [&](const Vector6d& xi) {
      return EvaluateNdt(level, kOutlierShare, source, pose * se3::Exp(xi)).cost;
    };
    gradient[i] = (cost(delta) - cost(-delta)) / (2.0 * step);
  }
  return gradient;
}

class Derivatives : public testing::TestWithParam<double> {};

TEST_P(Derivatives, GradientIsThatOfTheCost) {
  const double resolution_m = GetParam();
  std::mt19937 random(11);
  const NdtLevel level = Blobs(resolution_m, random);
  for (int trial = 0; trial < 10; ++trial) {
    Pose pose = se3::Exp(RandomVector(random, 1.5));
    pose.translation() += Eigen::Vector3d::Constant(4.0 * resolution_m);
    const Points source = AwayFromBorders(pose, resolution_m, random);
    const Vector6d analytic = EvaluateNdt(level, kOutlierShare, source, pose).gradient;
    const Vector6d numeric = NumericGradient(level, source, pose);
    EXPECT_LT((analytic - numeric).head<3>().norm(), 2e-3 * numeric.head<3>().norm());
    EXPECT_LT((analytic - numeric).tail<3>().norm(), 2e-3 * numeric.tail<3>().norm());
  }
}

TEST_P(Derivatives, HessianIsSymmetricAndPositive) {
  const double resolution_m = GetParam();
  std::mt19937 random(12);
  const NdtLevel level = Blobs(resolution_m, random);
  for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{600}}) {
    Pose pose = se3::Exp(RandomVector(random, 1.5));
    pose.translation() += Eigen::Vector3d::Constant(4.0 * resolution_m);
    Points source = AwayFromBorders(pose, resolution_m, random);
    source.resize(count);
    const Matrix6d hessian = EvaluateNdt(level, kOutlierShare, source, pose).hessian;
    const double largest = hessian.cwiseAbs().maxCoeff();
    EXPECT_LT((hessian - hessian.transpose()).norm(), 1e-6 * largest);
    const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(hessian);
    EXPECT_GT(solver.eigenvalues()[0], -1e-6 * largest);
    EXPECT_GT(solver.eigenvalues()[5], 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Resolutions, Derivatives, testing::Values(1.0, 3.0));

TEST(NdtCostTest, HessianPredictsTheGradientAtTheMinimum) {
  // Gauss-Newton: exact where residuals vanish. Points at the means of the voxels have none.
  std::mt19937 random(13);
  const NdtLevel level = Blobs(1.0, random);
  Points means;
  for (const NdtVoxel& voxel : level.voxels()) means.push_back(voxel.mean);
  const Pose identity = Pose::Identity();
  const NdtCost at = EvaluateNdt(level, kOutlierShare, means, identity);
  const Vector6d step = RandomVector(random, 1e-4);
  const NdtCost there = EvaluateNdt(level, kOutlierShare, means, se3::Exp(step));
  const Vector6d change = there.gradient - at.gradient;
  EXPECT_LT((change - at.hessian * step).norm(), 0.05 * change.norm());
}

TEST(NdtCostTest, ResultDoesNotDependOnThreads) {
  std::mt19937 random(14);
  const NdtLevel level = Blobs(1.0, random);
  const Pose pose = MakePose(RotationFromRpy(0.1, 0.2, 0.3), Eigen::Vector3d::Constant(4.0));
  Points source;
  for (int i = 0; i < 20; ++i) {
    const Points more = AwayFromBorders(pose, 1.0, random);
    source.insert(source.end(), more.begin(), more.end());
  }
  // The slots of an arena decide how a sum is split up, however many threads are free.
  const auto evaluate = [&](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([&] { return EvaluateNdt(level, kOutlierShare, source, pose); });
  };
  const NdtCost one = evaluate(1);
  EXPECT_LT(one.cost, -1.0);
  for (const int threads : {2, 3, 8}) {
    const NdtCost several = evaluate(threads);
    EXPECT_EQ(one.cost, several.cost);
    EXPECT_EQ(one.gradient, several.gradient);
    EXPECT_EQ(one.hessian, several.hessian);
  }
}

TEST(NdtCostTest, FacesTurnedAwayDrawNothing) {
  constexpr float kThickness_m = 0.2F;
  std::mt19937 random(15);
  Points both;
  for (const float x : {0.4F, 0.4F + kThickness_m}) {
    AddFace({x, -3.0F, -1.0F}, 6.0F * Eigen::Vector3f::UnitY(), 2.0F * Eigen::Vector3f::UnitZ(),
            4000, 0.01F, random, both);
  }
  const NdtLevel wall(1.0, both);
  std::vector<NdtVoxel> towards_sensor;
  for (const NdtVoxel& voxel : wall.voxels()) {
    ASSERT_FALSE(voxel.facing.isZero());
    if (voxel.facing.x() < 0.0F) towards_sensor.push_back(voxel);
  }
  ASSERT_EQ(2 * towards_sensor.size(), wall.voxels().size());
  const NdtLevel near_face(1.0, towards_sensor);
  const Pose T_map_scan = MakePose(RotationFromRpy(0.0, 0.0, 0.3), {-3.0, 0.5, 0.0});
  Points scan;
  AddFace({0.4F, -1.5F, -1.0F}, 4.0F * Eigen::Vector3f::UnitY(), 2.0F * Eigen::Vector3f::UnitZ(),
          1000, 0.05F, random, scan);
  const Eigen::Isometry3f T_scan_map = T_map_scan.inverse().cast<float>();
  for (Eigen::Vector3f& point : scan) point = T_scan_map * point;
  const NdtCost cost = EvaluateNdt(wall, kOutlierShare, scan, T_map_scan);
  const NdtCost expected = EvaluateNdt(near_face, kOutlierShare, scan, T_map_scan);
  EXPECT_LT(cost.cost, -1000.0);
  EXPECT_EQ(cost.cost, expected.cost);
  EXPECT_EQ(cost.gradient, expected.gradient);
  // From behind, it is the far face that draws and the near one that does not.
  const Pose behind = MakePose(RotationFromRpy(0.0, 0.0, M_PI), {3.9, 0.5, 0.0});
  EXPECT_GT(EvaluateNdt(near_face, kOutlierShare, {{3.4F, 0.0F, 0.0F}}, behind).cost, -1e-9);
  EXPECT_LT(EvaluateNdt(wall, kOutlierShare, {{3.4F, 0.0F, 0.0F}}, behind).cost, -0.1);
}

}  // namespace
}  // namespace hv::relocalize
