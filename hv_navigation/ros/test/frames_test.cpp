#include "frames.h"

#include <gtest/gtest.h>

#include "hv_ros/conversions.h"

namespace hv::navigation {
namespace {

constexpr double kTimeout_s = 0.6;
constexpr bool kStatic = true;

Time At(double seconds) { return Time::FromSeconds(100.0 + seconds); }

Pose Shifted(double x, double yaw = 0.0) {
  return MakePose(RotationFromRpy(0.0, 0.0, yaw), Eigen::Vector3d(x, 0.0, 0.0));
}

class FramesTest : public testing::Test {
 protected:
  void Tell(double seconds, double x, bool is_static = false) {
    geometry_msgs::TransformStamped message;
    message.header.frame_id = "map";
    message.header.stamp = ToRos(At(seconds));
    message.child_frame_id = "odom";
    message.transform = ToTransform(Shifted(x));
    buffer_.setTransform(message, "test", is_static);
  }

  std::optional<Pose> PlaceAt(double seconds) const {
    return PlaceOfOdometry(buffer_, "map", "odom", At(seconds), kTimeout_s);
  }

  tf2_ros::Buffer buffer_;
};

TEST_F(FramesTest, ThePlaceIsLostWhenNobodyTellsItAnyMore) {
  EXPECT_FALSE(PlaceAt(0.0));
  Tell(0.0, 1.0);
  Tell(0.1, 2.0);
  ASSERT_TRUE(PlaceAt(0.2));
  EXPECT_EQ(PlaceAt(0.2)->translation().x(), 2.0);
  EXPECT_TRUE(PlaceAt(0.65));
  EXPECT_FALSE(PlaceAt(0.75));
  Tell(0.8, 3.0);
  EXPECT_TRUE(PlaceAt(0.9));
}

TEST_F(FramesTest, AFixedPlaceIsNeverLost) {
  Tell(0.0, 1.0, kStatic);
  EXPECT_TRUE(PlaceAt(1000.0));
  EXPECT_TRUE(PlaceOfOdometry(buffer_, "odom", "odom", At(0.0), kTimeout_s));
}

TEST(PlaceJumps, SlowCorrectionsAreNone) {
  PlaceJumps jumps(0.5, 0.1);
  for (int i = 0; i < 200; ++i)
    EXPECT_FALSE(jumps.Add(At(0.1 * i), Shifted(0.02 * i), Pose::Identity()));
}

TEST(PlaceJumps, FastOnesAreToldOnce) {
  PlaceJumps jumps(0.5, 0.1);
  int told = 0;
  for (int i = 0; i < 50; ++i) {
    const double x = i < 20 ? 0.0 : std::min(0.08, 0.02 * (i - 20)) * 10.0;
    told += jumps.Add(At(0.1 * i), Shifted(x), Pose::Identity()) ? 1 : 0;
  }
  EXPECT_EQ(told, 1);
}

TEST(PlaceJumps, WhatWasBeforeALossCounts) {
  PlaceJumps jumps(0.5, 0.1);
  EXPECT_FALSE(jumps.Add(At(0.0), Shifted(0.0), Pose::Identity()));
  EXPECT_TRUE(jumps.Add(At(60.0), Shifted(5.0), Pose::Identity()));
}

TEST(PlaceJumps, ATurnAboutTheRobotIsNoShift) {
  PlaceJumps jumps(0.5, 0.1);
  const Pose T_odom_base = Shifted(100.0);
  const auto turned = [&](double yaw) {
    return T_odom_base * Shifted(0.0, yaw) * T_odom_base.inverse();
  };
  EXPECT_FALSE(jumps.Add(At(0.0), turned(0.0), T_odom_base));
  EXPECT_FALSE(jumps.Add(At(0.1), turned(0.08), T_odom_base));
  EXPECT_TRUE(jumps.Add(At(0.2), turned(0.12), T_odom_base));
}

}  // namespace
}  // namespace hv::navigation
