#include "hv_navigation/depth_projection.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "solid_scene.h"

namespace hv::navigation {
namespace {

using Eigen::Vector3d;

const DepthCameraModel kRealCamera{385.0, 386.0, 320.5, 239.0};

/// Depth of the scene at every pixel, with a share of pixels at random depths.
DepthImage Render(const SolidScene& scene, const Pose& T_odom_camera, double noise = 0.0) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform;
  DepthImage image;
  image.width = 640;
  image.height = 480;
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      const Vector3d ray((column - kRealCamera.cx) / kRealCamera.fx,
                         (row - kRealCamera.cy) / kRealCamera.fy, 1.0);
      const double range =
          scene.Cast(T_odom_camera.translation(), T_odom_camera.linear() * ray.normalized());
      double depth = range / ray.norm();
      if (noise > 0.0 && uniform(random) < noise) depth = 0.5 + 3.0 * uniform(random);
      image.depth_mm.push_back(depth < 60.0 ? static_cast<std::uint16_t>(std::lround(1e3 * depth))
                                            : std::uint16_t{0});
    }
  }
  return image;
}

Vector3d In(const Pose& T_odom_camera, const Point& point) {
  return T_odom_camera * Eigen::Vector3f(point.x, point.y, point.z).cast<double>();
}

TEST(DepthProjectionTest, PointsLieOnThePlanes) {
  SolidScene scene;
  scene.AddFloor(-1.0, 20.0);
  scene.AddBox({2.5, -3.0, 0.0}, {3.0, 3.0, 3.0});
  const Pose T_odom_camera = CameraPose(0.2, 0.5, 12.0);
  const DepthCloud cloud = ProjectDepth(Render(scene, T_odom_camera), kRealCamera, DepthConfig{});
  EXPECT_FALSE(cloud.report.refused);
  ASSERT_GT(cloud.points.size(), 10000U);
  std::size_t on_floor = 0;
  for (const Point& point : cloud.points) {
    const Vector3d at = In(T_odom_camera, point);
    const double off = std::min(std::abs(at.z()), std::abs(at.x() - 2.5));
    EXPECT_LT(off, 0.004);
    EXPECT_GT(point.z, 0.0F);
    on_floor += std::abs(at.z()) < 0.004;
  }
  EXPECT_GT(on_floor, 2000U);
}

TEST(DepthProjectionTest, DecimationTakesOnePointATile) {
  SolidScene scene;
  scene.AddBox({2.0, -9.0, -9.0}, {3.0, 9.0, 9.0});
  const DepthImage image = Render(scene, CameraPose(0.0, 0.5, 0.0));
  for (const int decimation : {1, 4, 7, 1000}) {
    DepthConfig config;
    config.decimation = decimation;
    const auto tiles = static_cast<std::size_t>(((640 + decimation - 1) / decimation) *
                                                ((480 + decimation - 1) / decimation));
    EXPECT_EQ(ProjectDepth(image, kRealCamera, config).points.size(), tiles);
  }
}

class ThinPost : public testing::TestWithParam<double> {};

TEST_P(ThinPost, StaysAndFlyingPixelsGo) {
  SolidScene scene;
  scene.AddBox({3.5, -9.0, -9.0}, {4.0, 9.0, 9.0});
  scene.AddBox({1.975, -0.5 * GetParam(), 0.0}, {2.025, 0.5 * GetParam(), 0.9});
  const Pose T_odom_camera = CameraPose(0.0, 0.5, 0.0);
  DepthImage image = Render(scene, T_odom_camera);
  std::size_t rims = 0;
  for (std::size_t i = 1; i + 1 < image.depth_mm.size(); ++i) {
    if (image.depth_mm[i + 1] + 1000 >= image.depth_mm[i]) continue;
    image.depth_mm[i] = static_cast<std::uint16_t>((image.depth_mm[i] + image.depth_mm[i + 1]) / 2);
    ++rims;
  }
  ASSERT_GT(rims, 150U);
  const DepthCloud cloud = ProjectDepth(image, kRealCamera, DepthConfig{});
  EXPECT_GE(cloud.report.flying, rims * 9 / 10);
  std::size_t on_post = 0;
  std::size_t in_between = 0;
  for (const Point& point : cloud.points) {
    on_post += point.z < 2.1F;
    in_between += point.z > 2.1F && point.z < 3.4F;
  }
  EXPECT_GT(on_post, 35U);
  EXPECT_EQ(in_between, 0U);
}

INSTANTIATE_TEST_SUITE_P(Width, ThinPost, testing::Values(0.05, 0.011));

TEST(DepthProjectionTest, SpecklesGo) {
  SolidScene scene;
  scene.AddBox({3.8, -9.0, -9.0}, {4.5, 9.0, 9.0});
  const DepthCloud cloud =
      ProjectDepth(Render(scene, CameraPose(0.0, 0.5, 0.0), 0.01), kRealCamera, DepthConfig{});
  EXPECT_GT(cloud.points.size(), 19000U);
  for (const Point& point : cloud.points) EXPECT_NEAR(point.z, 3.8, 0.11);
}

TEST(DepthProjectionTest, RangesAreLimited) {
  SolidScene scene;
  scene.AddFloor(-1.0, 50.0);
  const DepthCloud cloud =
      ProjectDepth(Render(scene, CameraPose(0.0, 0.5, 0.0)), kRealCamera, DepthConfig{});
  EXPECT_GT(cloud.report.out_of_range, 1000U);
  EXPECT_GT(cloud.report.without_depth, 640U * 200U);
  for (const Point& point : cloud.points) EXPECT_LE(point.z, 4.0F);
}

TEST(DepthProjectionTest, BadImagesGiveNoPoints) {
  SolidScene scene;
  scene.AddBox({2.0, -9.0, -9.0}, {3.0, 9.0, 9.0});
  const DepthImage good = Render(scene, CameraPose(0.0, 0.5, 0.0));
  const auto refused = [](const DepthImage& image, const DepthCameraModel& camera) {
    const DepthCloud cloud = ProjectDepth(image, camera, DepthConfig{});
    return cloud.report.refused && cloud.points.empty();
  };
  EXPECT_FALSE(refused(good, kRealCamera));
  EXPECT_TRUE(refused({}, kRealCamera));
  DepthImage bad = good;
  bad.depth_mm.pop_back();
  EXPECT_TRUE(refused(bad, kRealCamera));
  bad = good;
  bad.width = -640;
  bad.height = -480;
  EXPECT_TRUE(refused(bad, kRealCamera));
  DepthCameraModel model = kRealCamera;
  model.fx = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(refused(good, model));
  EXPECT_TRUE(refused(good, {}));
  bad = good;
  std::fill(bad.depth_mm.begin(), bad.depth_mm.end(), std::uint16_t{0});
  EXPECT_FALSE(refused(bad, kRealCamera));
  EXPECT_TRUE(ProjectDepth(bad, kRealCamera, DepthConfig{}).points.empty());
}

}  // namespace
}  // namespace hv::navigation
