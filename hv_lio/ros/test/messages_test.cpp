#include <gtest/gtest.h>

#include "hv_core/se3.h"
#include "voxel_markers.h"

namespace hv::lio {
namespace {

TEST(VoxelMarkers, EachKindHasItsNamespaceAndMergedPlanesShareAColour) {
  std::vector<VoxelView> voxels(4);
  voxels[0].kind = VoxelView::Kind::kPlane;
  for (int i : {1, 2}) {
    voxels[i].kind = VoxelView::Kind::kMergedPlane;
    voxels[i].plane_id = 5;
  }
  voxels[3].kind = VoxelView::Kind::kMergedPlane;
  voxels[3].plane_id = 6;
  for (VoxelView& voxel : voxels) voxel.size = 1.0;
  const auto array = ToVoxelMarkers(voxels, "odom", Time::FromSeconds(1.0));
  ASSERT_EQ(array.markers.size(), 3U);
  EXPECT_EQ(array.markers[0].points.size(), 24U);  // a disc of 8 triangles
  ASSERT_EQ(array.markers[1].colors.size(), 18U);  // three squares of 2 triangles
  EXPECT_EQ(array.markers[1].colors[0].r, array.markers[1].colors[6].r);
  EXPECT_NE(array.markers[1].colors[0].r, array.markers[1].colors[12].r);
  EXPECT_EQ(array.markers[2].action, visualization_msgs::Marker::DELETE);
}

TEST(VoxelMarkers, ShapesLieInTheirPlane) {
  VoxelView voxel;
  voxel.kind = VoxelView::Kind::kPlane;
  voxel.center = {1.0, 2.0, 3.0};
  voxel.sigma = {0.2, 0.1, 0.0};
  voxel.size = 1.0;
  voxel.axes = RotationFromRpy(0.0, M_PI / 2.0, 0.0);  // the normal along x
  const auto array = ToVoxelMarkers({voxel}, "odom", Time::FromSeconds(1.0));
  for (const auto& point : array.markers[0].points) EXPECT_NEAR(point.x, 1.0, 1e-9);
}

}  // namespace
}  // namespace hv::lio
