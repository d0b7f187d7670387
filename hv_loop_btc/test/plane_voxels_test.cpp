#include "hv_loop_btc/plane_voxels.h"

#include <gtest/gtest.h>

#include "town.h"

namespace hv::loop {
namespace {

TEST(PlaneVoxelsTest, NormalsAreThoseOfTheSurfaces) {
  const Town town(2);
  std::mt19937 random(1);
  const Submap submap = town.SubmapAt(0, SensorPose(0.0, 0.0, 0.0), random);
  const auto planes = ExtractPlaneVoxels(submap.points, {0.5, 10, 0.1});
  ASSERT_GT(planes.size(), 200U);
  int axis_aligned = 0;
  for (const PlaneVoxel& plane : planes) {
    EXPECT_NEAR(plane.normal.norm(), 1.0F, 1e-4F);
    axis_aligned += plane.normal.cwiseAbs().maxCoeff() > 0.97F;
  }
  EXPECT_GT(axis_aligned, 0.9 * static_cast<double>(planes.size()));
}

TEST(PlaneVoxelsTest, TheFloorIsFoundUnderATiltedSensor) {
  const Town town(2);
  std::mt19937 random(1);
  const Pose pose = SensorPose(1.0, 0.0, 0.7, 0.15, -0.1);
  const Submap submap = town.SubmapAt(0, pose, random);
  const auto planes = ExtractPlaneVoxels(submap.points, {0.5, 10, 0.1});
  const ReferencePlane floor = FindFloor(planes, submap.up, submap.points);
  EXPECT_GT(floor.normal.dot(submap.up), 0.9995);
  EXPECT_NEAR(floor.offset, -1.2, 0.03);
}

TEST(PlaneVoxelsTest, WithoutAFloorTheLowestPointsGiveTheHeight) {
  std::vector<Eigen::Vector3f> wall;
  for (int i = 0; i < 1000; ++i) {
    wall.emplace_back(5.0F, 0.01F * static_cast<float>(i), -1.0F + 0.003F * static_cast<float>(i));
  }
  const ReferencePlane floor = FindFloor({}, Eigen::Vector3d::UnitZ(), wall);
  EXPECT_EQ(floor.normal, Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(floor.offset, -0.94, 0.02);
}

}  // namespace
}  // namespace hv::loop
