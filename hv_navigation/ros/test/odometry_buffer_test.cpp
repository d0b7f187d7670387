#include "odometry_buffer.h"

#include <limits>

#include <gtest/gtest.h>

#include "hv_ros/conversions.h"

namespace hv::navigation {
namespace {

Time StampAt(double seconds) { return Time::FromSeconds(100.0 + seconds); }

/// A robot that drives 1 m/s along x.
nav_msgs::Odometry MessageAt(double seconds) {
  nav_msgs::Odometry message;
  message.header.stamp = ToRos(StampAt(seconds));
  message.header.frame_id = "odom";
  message.child_frame_id = "base_link";
  message.pose.pose =
      ToPoseMessage(MakePose(Eigen::Matrix3d::Identity(), Eigen::Vector3d(seconds, 0.0, 0.0)));
  message.twist.twist.linear.x = 1.0;
  return message;
}

double XOf(const std::optional<Pose>& pose) { return pose ? pose->translation().x() : -1e9; }

TEST(OdometryBuffer, TellsThePoseBetweenMessages) {
  OdometryBuffer buffer;
  EXPECT_FALSE(buffer.Newest());
  EXPECT_FALSE(buffer.PoseAt(StampAt(0.0)));
  for (int i = 0; i <= 10; ++i) EXPECT_TRUE(buffer.Add(MessageAt(0.1 * i), StampAt(0.1 * i)));
  EXPECT_NEAR(XOf(buffer.PoseAt(StampAt(0.55))), 0.55, 1e-9);
  EXPECT_NEAR(XOf(buffer.PoseAt(StampAt(0.0))), 0.0, 1e-9);
  EXPECT_FALSE(buffer.PoseAt(StampAt(-0.01)));
  EXPECT_EQ(buffer.Newest()->stamp, StampAt(1.0));
  EXPECT_EQ(buffer.Newest()->base_frame, "base_link");
}

TEST(OdometryBuffer, GoesOnALittleBehindTheLastMessage) {
  OdometryBuffer buffer;
  buffer.Add(MessageAt(1.0), StampAt(1.0));
  EXPECT_NEAR(XOf(buffer.PoseAt(StampAt(1.1))), 1.1, 1e-9);
  EXPECT_FALSE(buffer.PoseAt(StampAt(1.5)));
}

TEST(OdometryBuffer, GapsAreNotBridged) {
  OdometryBuffer buffer;
  buffer.Add(MessageAt(0.0), StampAt(0.0));
  buffer.Add(MessageAt(2.0), StampAt(2.0));
  EXPECT_FALSE(buffer.PoseAt(StampAt(1.0)));
}

TEST(OdometryBuffer, ForgetsWhatIsOldAndWhatWasBeforeAJumpBack) {
  OdometryBuffer buffer;
  for (int i = 0; i <= 100; ++i) buffer.Add(MessageAt(0.1 * i), StampAt(0.1 * i));
  EXPECT_FALSE(buffer.PoseAt(StampAt(6.0)));
  EXPECT_TRUE(buffer.PoseAt(StampAt(8.0)));
  buffer.Add(MessageAt(5.0), StampAt(10.1));
  EXPECT_EQ(buffer.Newest()->stamp, StampAt(5.0));
  EXPECT_FALSE(buffer.PoseAt(StampAt(8.0)));
}

TEST(OdometryBuffer, RefusesWhatIsNotFinite) {
  OdometryBuffer buffer;
  nav_msgs::Odometry message = MessageAt(0.0);
  message.twist.twist.angular.z = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(buffer.Add(message, StampAt(0.0)));
  message = MessageAt(0.0);
  message.pose.pose.orientation.w = 0.0;
  EXPECT_FALSE(buffer.Add(message, StampAt(0.0)));
  EXPECT_EQ(buffer.refused(), 2U);
  EXPECT_FALSE(buffer.Newest());
}

TEST(OdometryBuffer, AnotherClockIsToldFromALateOne) {
  OdometryBuffer buffer;
  EXPECT_EQ(buffer.SensorTime(StampAt(7.0)), StampAt(7.0));
  buffer.Add(MessageAt(1.0), StampAt(1.4));
  EXPECT_EQ(buffer.SensorTime(StampAt(1.5)), StampAt(1.5)) << "late, and known to be";
  buffer.Add(MessageAt(2.0), StampAt(1002.0));
  EXPECT_NEAR(buffer.SensorTime(StampAt(1002.3)) - StampAt(2.3), 0.0, 1e-6);
}

}  // namespace
}  // namespace hv::navigation
