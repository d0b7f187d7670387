#include "hv_relocalize_ndt/ndt_level.h"

#include <cmath>
#include <random>
#include <set>
#include <tuple>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "hv_core/so3.h"
#include "surfaces.h"

namespace hv::relocalize {
namespace {

using Eigen::Vector3f;
using Points = std::vector<Vector3f>;

/// Points around `center`, spread by `sigmas` along turned axes.
Points Blob(const Vector3f& center, const Vector3f& sigmas, int count, std::mt19937& random) {
  std::normal_distribution<float> normal;
  const Eigen::Matrix3f axes = so3::Exp(Eigen::Vector3d(0.4, -0.7, 1.1)).cast<float>();
  Points points;
  for (int i = 0; i < count; ++i) {
    const Vector3f unit(normal(random), normal(random), normal(random));
    points.push_back(center + axes * sigmas.cwiseProduct(unit));
  }
  return points;
}

Eigen::Matrix3d CovarianceOf(const Points& points) {
  Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    columns.col(static_cast<Eigen::Index>(i)) = points[i].cast<double>();
  }
  const Eigen::Matrix3Xd centred = columns.colwise() - columns.rowwise().mean();
  return centred * centred.transpose() / (static_cast<double>(points.size()) - 1.0);
}

TEST(NdtLevelTest, MeanAndCovarianceOfAVoxel) {
  std::mt19937 random(3);
  const Points points = Blob({5.0F, -5.0F, 15.0F}, {0.9F, 0.6F, 0.3F}, 200, random);
  const NdtLevel level(10.0, points);
  ASSERT_EQ(level.voxels().size(), 1U);
  const NdtVoxel& voxel = level.voxels().front();
  EXPECT_EQ(voxel.points, 200U);
  Vector3f mean = Vector3f::Zero();
  for (const Vector3f& point : points) mean += point / 200.0F;
  EXPECT_LT((voxel.mean - mean).norm(), 1e-4F);
  const Eigen::Matrix3d covariance = CovarianceOf(points);
  const Eigen::Matrix3d product = covariance * voxel.information.cast<double>();
  EXPECT_LT((product - Eigen::Matrix3d::Identity()).norm(), 1e-4);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  const Eigen::Vector3d variances = solver.eigenvalues();
  EXPECT_NEAR(std::abs(solver.eigenvectors().col(0).dot(voxel.normal.cast<double>())), 1.0, 1e-5);
  EXPECT_NEAR(voxel.thickness_m, std::sqrt(variances[0]), 1e-4);
  EXPECT_NEAR(voxel.flatness, variances[0] / variances[1], 1e-4);
}

TEST(NdtLevelTest, FivePointsMakeAVoxelFourDoNot) {
  std::mt19937 random(4);
  const Points points = Blob({0.5F, 0.5F, 0.5F}, {0.1F, 0.1F, 0.1F}, 5, random);
  EXPECT_EQ(NdtLevel(1.0, points).voxels().size(), 1U);
  const NdtLevel too_few(1.0, Points(points.begin(), points.end() - 1));
  EXPECT_TRUE(too_few.voxels().empty());
  EXPECT_EQ(too_few.Around(points.front()), nullptr);
}

TEST(NdtLevelTest, SmallEigenvaluesAreRaised) {
  std::mt19937 random(5);
  Points points;
  AddFace({0.0F, 0.0F, 0.5F}, Vector3f::UnitX(), Vector3f::UnitY(), 2000, 0.015F, random, points);
  const NdtLevel level(1.0, points);
  ASSERT_EQ(level.voxels().size(), 1U);
  const NdtVoxel& voxel = level.voxels().front();
  const Eigen::Matrix3d covariance = voxel.information.cast<double>().inverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  EXPECT_NEAR(solver.eigenvalues()[0] / solver.eigenvalues()[2], 0.01, 1e-4);
  EXPECT_NEAR(voxel.thickness_m, 0.015F, 0.001F);
  EXPECT_TRUE(voxel.planar());
}

TEST(NdtLevelTest, PointsThatCoincideAreABlobOfOneCentimetre) {
  const NdtLevel level(1.0, Points(20, Vector3f(0.3F, 0.4F, 0.5F)));
  ASSERT_EQ(level.voxels().size(), 1U);
  const Eigen::Matrix3f expected = 1e4F * Eigen::Matrix3f::Identity();
  EXPECT_LT((level.voxels().front().information - expected).norm(), 1.0F);
}

/// Thickness of a wall, where its middle lies in a cube of 1 m, and its axis.
class Wall : public testing::TestWithParam<std::tuple<float, float, int>> {};

TEST_P(Wall, HasTwoVoxelsThatFaceOutwards) {
  const auto [thickness_m, middle_m, axis] = GetParam();
  std::mt19937 random(6);
  const Vector3f across = Vector3f::Unit(axis);
  const Vector3f u = Vector3f::Unit((axis + 1) % 3);
  const Vector3f v = Vector3f::Unit((axis + 2) % 3);
  Points points;
  for (const float side : {-0.5F, 0.5F}) {
    AddFace((middle_m + side * thickness_m) * across, u, v, 300, 0.01F, random, points);
  }
  const NdtLevel level(1.0, points);
  ASSERT_EQ(level.voxels().size(), 2U);
  for (const NdtVoxel& voxel : level.voxels()) {
    const float side = across.dot(voxel.mean) > middle_m ? 0.5F : -0.5F;
    EXPECT_NEAR(across.dot(voxel.mean), middle_m + side * thickness_m, 0.003F);
    EXPECT_TRUE(voxel.planar());
    EXPECT_GT(2.0F * side * across.dot(voxel.facing), 0.99F);
  }
}

INSTANTIATE_TEST_SUITE_P(WithinACubeAndAcrossTwo, Wall,
                         testing::Combine(testing::Values(0.12F, 0.18F, 0.25F),
                                          testing::Values(0.5F, 1.0F), testing::Values(0, 1, 2)));

TEST(NdtLevelTest, ACornerIsOneVoxelThatFacesNowhere) {
  std::mt19937 random(7);
  Points points;
  const Vector3f middle(0.5F, 0.5F, 0.0F);
  AddFace(middle, 0.5F * Vector3f::UnitX(), Vector3f::UnitZ(), 300, 0.01F, random, points);
  AddFace(middle, 0.5F * Vector3f::UnitY(), Vector3f::UnitZ(), 300, 0.01F, random, points);
  const NdtLevel level(1.0, points);
  ASSERT_EQ(level.voxels().size(), 1U);
  EXPECT_EQ(level.voxels().front().points, 600U);
  EXPECT_TRUE(level.voxels().front().facing.isZero());
}

TEST(NdtLevelTest, ASingleFaceFacesNowhere) {
  std::mt19937 random(8);
  Points points;
  AddFace({0.0F, 0.0F, 0.5F}, 3.0F * Vector3f::UnitX(), 3.0F * Vector3f::UnitY(), 2000, 0.01F,
          random, points);
  const NdtLevel level(1.0, points);
  EXPECT_EQ(level.voxels().size(), 9U);
  for (const NdtVoxel& voxel : level.voxels()) EXPECT_TRUE(voxel.facing.isZero());
}

Eigen::Vector3i CubeAt(const Vector3f& point, float size) {
  return (point / size).array().floor().cast<int>();
}

TEST(NdtLevelTest, AroundGivesTheVoxelsOfSevenCubes) {
  constexpr float kSize = 0.5F;
  std::mt19937 random(9);
  std::uniform_real_distribution<float> place(-2.5F, 2.5F);
  Points points;
  for (int i = 0; i < 3000; ++i) {
    points.emplace_back(-std::abs(place(random)), place(random), place(random));
  }
  for (const float z : {0.15F, 0.35F}) {
    AddFace({0.5F, -2.0F, z}, 2.0F * Vector3f::UnitX(), 4.0F * Vector3f::UnitY(), 2000, 0.005F,
            random, points);
  }
  const NdtLevel level(kSize, points);
  std::size_t most = 0;
  for (int query = 0; query < 2000; ++query) {
    const Vector3f at = 1.4F * Vector3f(place(random), place(random), place(random));
    std::set<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < level.voxels().size(); ++i) {
      const Eigen::Vector3i apart = CubeAt(level.voxels()[i].mean, kSize) - CubeAt(at, kSize);
      if (apart.cwiseAbs().sum() <= 1) expected.insert(i);
    }
    const NdtLevel::Neighbors* around = level.Around(at);
    ASSERT_EQ(around == nullptr, expected.empty());
    if (around == nullptr) continue;
    ASSERT_EQ(around->count, expected.size());
    const auto* const first = around->voxels.data();
    EXPECT_EQ(std::set<std::uint32_t>(first, first + around->count), expected);
    most = std::max(most, expected.size());
  }
  EXPECT_EQ(most, 10U) << "both faces of a slab in five cubes";
}

}  // namespace
}  // namespace hv::relocalize
