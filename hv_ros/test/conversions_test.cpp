#include "hv_ros/conversions.h"

#include <cstring>

#include <gtest/gtest.h>

namespace hv {
namespace {

TEST(Conversions, StampsSurviveTheWayThroughRos) {
  const Time stamp = Time::FromNanoseconds(1646310000819997311);
  EXPECT_EQ(FromRos(ToRos(stamp)), stamp);
  EXPECT_EQ(ToRos(Time::FromNanoseconds(-5)), ros::Time(0, 0));
}

TEST(Conversions, CloudsAreLaidOutAsDeclared) {
  std::vector<Point> points(2);
  points[1].y = 2.5F;
  points[1].intensity = 9.0F;
  const auto cloud = ToCloudMessage(points);
  ASSERT_EQ(cloud->data.size(), std::size_t{cloud->width} * cloud->point_step);
  float value = 0.0F;
  std::memcpy(&value, &cloud->data[cloud->point_step + cloud->fields[1].offset], sizeof(value));
  EXPECT_EQ(value, 2.5F);
  std::memcpy(&value, &cloud->data[cloud->point_step + cloud->fields[3].offset], sizeof(value));
  EXPECT_EQ(value, 9.0F);
}

TEST(Conversions, DecimationKeepsOnePointPerCube) {
  std::vector<Point> points(4);
  points[1].x = 0.4F;
  points[2].x = 0.6F;
  points[3].x = -0.1F;
  EXPECT_EQ(Decimated(points, 0.5).size(), 3U);
  EXPECT_EQ(Decimated(points, 0.0).size(), 4U);
}

TEST(Conversions, PosesSurviveTheWayThroughRos) {
  const Pose pose = MakePose(RotationFromRpy(0.3, -0.2, 2.9), Eigen::Vector3d(4.0, -2.0, 1.0));
  EXPECT_TRUE(FromRos(ToPoseMessage(pose)).isApprox(pose, 1e-14));
  EXPECT_TRUE(FromRos(ToTransform(pose)).isApprox(pose, 1e-14));
}

}  // namespace
}  // namespace hv
