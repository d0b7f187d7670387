#include "hv_loop_btc/view_image.h"

#include <gtest/gtest.h>

namespace hv::loop {
namespace {

/// A wall across the x axis, 10 m wide and 2 m high.
std::vector<Eigen::Vector3f> Wall(float x) {
  std::vector<Eigen::Vector3f> points;
  for (float y = -5.0F; y <= 5.0F; y += 0.1F) {
    for (float z = -1.0F; z <= 1.0F; z += 0.1F) points.emplace_back(x, y, z);
  }
  return points;
}

TEST(ViewImageTest, SeesThroughWhatStandsBeforeItsSurfaces) {
  const ViewImage view(Wall(8.0F));
  const ViewImage::Comparison before = view.Compare(Wall(4.0F), Pose::Identity());
  EXPECT_GT(before.compared, 500U);
  EXPECT_EQ(before.seen_through, before.compared);
}

TEST(ViewImageTest, DoesNotSeeThroughItsOwnSurfacesOrWhatTheyHide) {
  const ViewImage view(Wall(8.0F));
  EXPECT_EQ(view.Compare(Wall(8.0F), Pose::Identity()).seen_through, 0U);
  EXPECT_EQ(view.Compare(Wall(12.0F), Pose::Identity()).seen_through, 0U);
}

TEST(ViewImageTest, PointsAreMovedIntoTheView) {
  const ViewImage view(Wall(8.0F));
  const Pose back = MakePose(Eigen::Matrix3d::Identity(), {-4.0, 0.0, 0.0});
  EXPECT_EQ(view.Compare(Wall(12.0F), back).seen_through, 0U);
  EXPECT_GT(view.Compare(Wall(8.0F), back).seen_through, 500U);
}

TEST(ViewImageTest, SaysNothingWhereItSeesNothing) {
  const ViewImage view(Wall(8.0F));
  const Pose behind = MakePose(Eigen::Matrix3d::Identity(), {-20.0, 0.0, 0.0});
  EXPECT_EQ(view.Compare(Wall(8.0F), behind).compared, 0U);
  EXPECT_EQ(ViewImage({}).Compare(Wall(8.0F), Pose::Identity()).compared, 0U);
}

}  // namespace
}  // namespace hv::loop
