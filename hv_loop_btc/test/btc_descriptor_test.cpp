#include "hv_loop_btc/btc_descriptor.h"

#include <algorithm>
#include <tuple>

#include <gtest/gtest.h>

#include "town.h"

namespace hv::loop {
namespace {

TEST(BitSimilarityTest, IsTheShareOfCommonBits) {
  EXPECT_EQ(BitSimilarity(0, 0), 0.0);
  EXPECT_EQ(BitSimilarity(0b1011, 0b1011), 1.0);
  EXPECT_EQ(BitSimilarity(0b1100, 0b0011), 0.0);
  EXPECT_DOUBLE_EQ(BitSimilarity(0b1110, 0b0111), 2.0 * 2.0 / 6.0);
  EXPECT_EQ(BitSimilarity(0b1110, 0b0110), BitSimilarity(0b0110, 0b1110));
}

/// Share of the keypoints of `a` that `b` has too, once moved.
double Repeated(const BtcDescriptor& a, const BtcDescriptor& b, const Pose& T_b_a,
                double tolerance) {
  int repeated = 0;
  for (const BtcKeypoint& keypoint : a.keypoints) {
    const Eigen::Vector3d moved = T_b_a * keypoint.position.cast<double>();
    repeated += std::any_of(b.keypoints.begin(), b.keypoints.end(), [&](const BtcKeypoint& other) {
      return (other.position.cast<double>() - moved).norm() < tolerance;
    });
  }
  return repeated / static_cast<double>(std::max<std::size_t>(1, a.keypoints.size()));
}

class InvarianceTest : public ::testing::TestWithParam<std::tuple<double, double, double>> {};

TEST_P(InvarianceTest, KeypointsAreThoseOfThePlaceNotOfTheView) {
  const auto [shift, yaw, tilt] = GetParam();
  const Town town(5);
  std::mt19937 random(9);
  const Pose first = SensorPose(0.0, 0.0, 0.0);
  const Pose second = SensorPose(shift, -0.5 * shift, yaw, tilt, -tilt);
  BtcExtractor extractor{BtcConfig()};
  const BtcDescriptor a = extractor.Extract(town.SubmapAt(0, first, random));
  const BtcDescriptor b = extractor.Extract(town.SubmapAt(1, second, random));
  ASSERT_GT(a.keypoints.size(), 15U);
  EXPECT_GT(Repeated(a, b, second.inverse() * first, 0.5), 0.7);
}

INSTANTIATE_TEST_SUITE_P(
    Views, InvarianceTest,
    ::testing::Values(std::make_tuple(0.0, 0.0, 0.0),  // the same place, sampled anew
                      std::make_tuple(0.0, 1.0, 0.0), std::make_tuple(0.0, M_PI, 0.0),
                      std::make_tuple(1.0, 0.0, 0.0), std::make_tuple(1.0, 2.5, 0.0),
                      std::make_tuple(0.5, -1.5, 0.1)));

TEST(BtcExtractorTest, TrianglesKeepTheirLimits) {
  const Town town(6);
  std::mt19937 random(1);
  BtcConfig config;
  config.max_triangles = 300;
  BtcExtractor extractor(config);
  const BtcDescriptor descriptor = extractor.Extract(town.SubmapAt(0, SensorPose(0, 0, 0), random));
  const BtcScale& scale = extractor.scale();
  EXPECT_GT(descriptor.triangles.size(), 100U);
  EXPECT_LE(descriptor.triangles.size(), 300U);
  for (const BtcTriangle& triangle : descriptor.triangles) {
    const Eigen::Vector3f sides = descriptor.Sides(triangle);
    EXPECT_LE(sides[0], sides[1]);
    EXPECT_LE(sides[1], sides[2]);
    EXPECT_GE(sides[0], static_cast<float>(scale.min_side_m) - 1e-4F);
    EXPECT_LE(sides[2], static_cast<float>(scale.max_side_m) + 1e-4F);
    EXPECT_LT(sides[2], 0.96F * (sides[0] + sides[1]));
  }
}

TEST(BtcExtractorTest, AStraightWallHasNoKeypointsButItsEnds) {
  Submap submap;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  for (int i = 0; i < 20000; ++i) {
    submap.points.emplace_back(20.0F * unit(random) - 10.0F, 4.0F, 3.0F * unit(random) - 1.2F);
    submap.points.emplace_back(20.0F * unit(random) - 10.0F, 8.0F * unit(random) - 4.0F, -1.2F);
  }
  BtcExtractor extractor{BtcConfig()};
  for (const BtcKeypoint& keypoint : extractor.Extract(submap).keypoints) {
    EXPECT_GT(std::abs(keypoint.position.x()), 8.5F);
  }
}

TEST(BtcExtractorTest, EmptyAndTinyCloudsGiveEmptyDescriptors) {
  BtcExtractor extractor{BtcConfig()};
  Submap submap;
  EXPECT_TRUE(extractor.Extract(submap).keypoints.empty());
  submap.points = {{1.0F, 2.0F, 0.5F}};
  EXPECT_TRUE(extractor.Extract(submap).triangles.empty());
}

TEST(BtcExtractorTest, TheFirstSubmapDecidesTheScale) {
  Submap far;
  for (int i = 0; i < 1000; ++i)
    far.points.emplace_back(20.0F + 0.01F * static_cast<float>(i), 0.0F, 0.0F);
  Submap near;
  for (int i = 0; i < 1000; ++i)
    near.points.emplace_back(2.0F + 0.001F * static_cast<float>(i), 0.0F, 0.0F);
  BtcExtractor outdoor{BtcConfig()};
  EXPECT_EQ(outdoor.scale_name(), "auto");
  outdoor.Extract(far);
  outdoor.Extract(near);
  EXPECT_EQ(outdoor.scale_name(), "outdoor");
  BtcExtractor indoor{BtcConfig()};
  indoor.Extract(near);
  EXPECT_EQ(indoor.scale_name(), "indoor");
}

}  // namespace
}  // namespace hv::loop
