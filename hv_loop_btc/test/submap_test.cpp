#include "hv_loop_btc/submap.h"

#include <limits>

#include <gtest/gtest.h>

namespace hv::loop {
namespace {

Keyframe KeyframeAt(std::uint32_t id, double x, std::uint32_t segment = 0) {
  Keyframe keyframe;
  keyframe.id = id;
  keyframe.segment = segment;
  keyframe.stamp = Time::FromSeconds(id);
  keyframe.T_odom_imu = MakePose(RotationFromRpy(0.1, 0.0, 0.3), {x, 0.0, 0.0});
  Point point;
  point.x = 1.0F;
  keyframe.points = {point};
  return keyframe;
}

SubmapConfig FourByTwo() {
  SubmapConfig config;
  config.keyframes = 4;
  config.stride = 2;
  return config;
}

TEST(SubmapBuilderTest, SubmapsOverlapByTheStride) {
  SubmapBuilder builder(FourByTwo());
  std::vector<Submap> submaps;
  for (std::uint32_t i = 0; i < 9; ++i) {
    if (const auto submap = builder.Add(KeyframeAt(i, i))) submaps.push_back(*submap);
  }
  ASSERT_EQ(submaps.size(), 3U);
  EXPECT_EQ(submaps[0].members.front().keyframe, 0U);
  EXPECT_EQ(submaps[0].members.back().keyframe, 3U);
  EXPECT_EQ(submaps[0].keyframe, 2U);
  EXPECT_EQ(submaps[1].members.front().keyframe, 2U);
  const auto rest = builder.Finish();
  ASSERT_TRUE(rest.has_value());
  EXPECT_EQ(rest->members.back().keyframe, 8U);
  EXPECT_FALSE(builder.Finish().has_value());
}

TEST(SubmapBuilderTest, ASubmapNeverCrossesASegment) {
  SubmapBuilder builder(FourByTwo());
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_FALSE(builder.Add(KeyframeAt(i, i)).has_value());
  const auto first = builder.Add(KeyframeAt(3, 100.0, 1));
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(first->members.size(), 3U);
  EXPECT_EQ(first->members.back().keyframe, 2U);
}

TEST(SubmapBuilderTest, PointsLieInTheFrameOfTheMiddleKeyframe) {
  SubmapBuilder builder(FourByTwo());
  std::optional<Submap> submap;
  for (std::uint32_t i = 0; i < 4; ++i) submap = builder.Add(KeyframeAt(i, 2.0 * i));
  ASSERT_TRUE(submap.has_value());
  ASSERT_EQ(submap->points.size(), 4U);
  EXPECT_LT((submap->points[2] - Eigen::Vector3f(1.0F, 0.0F, 0.0F)).norm(), 1e-5F);
  const Eigen::Vector3d up = RotationFromRpy(0.1, 0.0, 0.3).transpose() * Eigen::Vector3d::UnitZ();
  EXPECT_LT((submap->up - up).norm(), 1e-9);
}

TEST(SubmapBuilderTest, FarAndNotFinitePointsAreLeftOut) {
  SubmapConfig config;
  config.keyframes = 1;
  config.stride = 1;
  SubmapBuilder builder(config);
  Keyframe keyframe = KeyframeAt(0, 0.0);
  Point far;
  far.x = 1000.0F;
  Point broken;
  broken.y = std::numeric_limits<float>::quiet_NaN();
  keyframe.points.push_back(far);
  keyframe.points.push_back(broken);
  EXPECT_EQ(builder.Add(keyframe)->points.size(), 1U);
}

TEST(ThinnedTest, KeepsOneMeanACube) {
  const std::vector<Eigen::Vector3f> points = {
      {0.1F, 0.1F, 0.1F}, {0.3F, 0.1F, 0.1F}, {1.5F, 0.0F, 0.0F}, {-0.1F, 0.0F, 0.0F}};
  const std::vector<Eigen::Vector3f> thinned = Thinned(points, 1.0);
  ASSERT_EQ(thinned.size(), 3U);
  EXPECT_LT((thinned[0] - Eigen::Vector3f(0.2F, 0.1F, 0.1F)).norm(), 1e-6F);
}

}  // namespace
}  // namespace hv::loop
