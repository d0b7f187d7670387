#include "hv_ros/path_history.h"

#include <gtest/gtest.h>

namespace hv {
namespace {

Pose PoseAtX(double x) {
  return MakePose(Eigen::Quaterniond::Identity(), Eigen::Vector3d(x, 0.0, 0.0));
}

TEST(PathHistory, IsBoundedAndKeepsBothEnds) {
  PathHistory path(0.1, 100);
  for (int i = 0; i <= 1000; ++i) path.Add(Time::FromSeconds(1.0 + i), PoseAtX(0.2 * i));
  EXPECT_LE(path.size(), 100U);
  const nav_msgs::Path message = path.ToMessage("odom");
  EXPECT_EQ(message.poses.front().pose.position.x, 0.0);
  EXPECT_GT(message.poses.back().pose.position.x, 190.0);
  EXPECT_EQ(message.header.frame_id, "odom");
}

TEST(PathHistory, SkipsStandstillAndStartsOverWhenTimeJumpsBack) {
  PathHistory path(0.1, 100);
  EXPECT_TRUE(path.Add(Time::FromSeconds(10.0), PoseAtX(0.0)));
  EXPECT_FALSE(path.Add(Time::FromSeconds(11.0), PoseAtX(0.05)));
  EXPECT_TRUE(path.Add(Time::FromSeconds(2.0), PoseAtX(0.0)));
  EXPECT_EQ(path.size(), 1U);
}

}  // namespace
}  // namespace hv
