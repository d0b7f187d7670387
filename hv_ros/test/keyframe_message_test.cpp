#include "hv_ros/keyframe_message.h"

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "hv_ros/conversions.h"

namespace hv {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Keyframe Example() {
  Keyframe keyframe;
  keyframe.id = 41;
  keyframe.segment = 3;
  keyframe.stamp = Time::FromNanoseconds(1646310000819997311);
  keyframe.T_odom_imu = MakePose(RotationFromRpy(0.3, -0.2, 1.1), Eigen::Vector3d(4, -2, 1));
  Matrix6d root;
  for (int i = 0; i < 36; ++i) root(i / 6, i % 6) = std::sin(1.0 + i);
  keyframe.covariance = 1e-4 * (root * root.transpose() + Matrix6d::Identity());
  keyframe.gravity_odom = {0.01, -0.02, -9.81};
  keyframe.degenerate_translation = {Eigen::Vector3d::UnitX()};
  keyframe.degenerate_rotation = {Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY()};
  keyframe.points.resize(3);
  keyframe.points[1].x = 2.5F;
  keyframe.points[2].intensity = 9.0F;
  return keyframe;
}

hv_msgs::Keyframe ExampleMessage() {
  return *ToMessage(Example(), {Time::FromSeconds(7.0), "odom", "imu", {0.1, 0.2, 0.3}});
}

TEST(KeyframeMessage, KeepsEverything) {
  const Keyframe before = Example();
  const DecodedKeyframe decoded = FromMessage(ExampleMessage());
  const Keyframe& after = decoded.keyframe;
  ASSERT_EQ(decoded.error, "");
  EXPECT_EQ(after.id, before.id);
  EXPECT_EQ(after.segment, before.segment);
  EXPECT_EQ(after.stamp, before.stamp);
  EXPECT_TRUE(after.T_odom_imu.isApprox(before.T_odom_imu, 1e-14));
  EXPECT_TRUE(after.covariance.isApprox(before.covariance, 1e-14));
  EXPECT_EQ(after.gravity_odom, before.gravity_odom);
  EXPECT_EQ(after.degenerate_translation, before.degenerate_translation);
  EXPECT_EQ(after.degenerate_rotation, before.degenerate_rotation);
  ASSERT_EQ(after.points.size(), 3U);
  EXPECT_EQ(after.points[1].x, 2.5F);
  EXPECT_EQ(after.points[2].intensity, 9.0F);
  EXPECT_EQ(decoded.header.odom_frame, "odom");
  EXPECT_EQ(decoded.header.lidar_in_imu, Eigen::Vector3d(0.1, 0.2, 0.3));
}

TEST(KeyframeMessage, PointsThatAreNotFiniteAreLeftOut) {
  hv_msgs::Keyframe message = ExampleMessage();
  const float infinite = std::numeric_limits<float>::infinity();
  std::memcpy(&message.cloud.data[message.cloud.point_step + 4], &infinite, sizeof(infinite));
  EXPECT_EQ(FromMessage(message).keyframe.points.size(), 2U);
}

TEST(KeyframeMessage, EveryFaultIsNamed) {
  const std::vector<std::function<void(hv_msgs::Keyframe&)>> faults{
      [](auto& message) { message.pose.pose.position.x = kNan; },
      [](auto& message) { message.pose.pose.orientation = geometry_msgs::Quaternion(); },
      [](auto& message) { message.pose.covariance[3] = 1.0; },
      [](auto& message) { message.pose.covariance[7] = -1.0; },
      [](auto& message) { message.gravity = geometry_msgs::Vector3(); },
      [](auto& message) { message.degenerate_rotation[0].y = kNan; },
      [](auto& message) { message.sensor_origin.z = kNan; },
      [](auto& message) { message.cloud.fields[2].name = "w"; },
      [](auto& message) { message.cloud.fields[0].offset = 14; },
      [](auto& message) { message.cloud.fields[0].datatype = sensor_msgs::PointField::FLOAT64; },
      [](auto& message) { message.cloud.is_bigendian = true; },
      [](auto& message) { message.cloud.data.resize(20); },
      [](auto& message) { message.cloud.row_step = 4; },
      [](auto& message) { message.cloud.height = 0xFFFFFFFF; },
      [](auto& message) { message.cloud.point_step = 0; }};
  for (std::size_t i = 0; i < faults.size(); ++i) {
    hv_msgs::Keyframe message = ExampleMessage();
    faults[i](message);
    EXPECT_NE(FromMessage(message).error, "") << "fault " << i;
  }
}

TEST(KeyframeMessage, AnEmptyCloudIsAKeyframe) {
  Keyframe keyframe = Example();
  keyframe.points.clear();
  EXPECT_EQ(FromMessage(*ToMessage(keyframe, {})).error, "");
}

}  // namespace
}  // namespace hv
