#include "live_messages.h"

#include <cmath>

#include <gtest/gtest.h>

#include "hv_core/se3.h"
#include "hv_ros/conversions.h"
#include "hv_sim/mesh_builder.h"

namespace hv::sim {
namespace {

using Eigen::Vector3d;

TEST(LiveMessagesTest, AnImageHoldsMillimetresRowByRow) {
  DepthImage image{Time::FromSeconds(12.5), 3, 2, {1, 2, 300, 4, 5000, 65000}};
  const sensor_msgs::Image message = ToImageMessage(image, "camera");
  EXPECT_EQ(message.header.frame_id, "camera");
  EXPECT_EQ(message.header.stamp, ros::Time(12, 500000000));
  EXPECT_EQ(message.encoding, "16UC1");
  EXPECT_EQ(message.step, 6U);
  ASSERT_EQ(message.data.size(), message.step * message.height);
  for (std::size_t i = 0; i < image.depth_mm.size(); ++i) {
    EXPECT_EQ(message.data[2 * i] + 256 * message.data[2 * i + 1], image.depth_mm[i]);
  }
}

TEST(LiveMessagesTest, TheCameraInfoGivesPixelsBackTheirRays) {
  const DepthCameraConfig camera;
  const sensor_msgs::CameraInfo info = ToCameraInfo(camera, Time::FromSeconds(1.0), "camera");
  EXPECT_EQ(info.width, 212U);
  EXPECT_EQ(info.height, 120U);
  // The border of the image, half a pixel outside of the last one, is the border of the view.
  const double right = (211.5 - info.K[2]) / info.K[0];
  const double bottom = (119.5 - info.K[5]) / info.K[4];
  EXPECT_NEAR(std::atan(right) * 180.0 / M_PI, 43.5, 1e-9);
  EXPECT_NEAR(std::atan(bottom) * 180.0 / M_PI, 29.0, 1e-9);
  EXPECT_EQ(info.K[0], info.P[0]);
  EXPECT_EQ(info.K[4], info.P[5]);
  EXPECT_EQ(info.K[2], info.P[2]);
  EXPECT_EQ(info.K[5], info.P[6]);
}

TEST(LiveMessagesTest, TheTwistIsInTheBaseFrame) {
  TrueState state;
  state.stamp = Time::FromSeconds(2.0);
  state.base.T_world_body = Upright({1.0, 2.0, 3.0}, M_PI_2);
  state.base.velocity = {0.0, 0.7, 0.0};
  state.base.angular_velocity = {0.0, 0.0, 0.2};
  const nav_msgs::Odometry message = ToOdometryMessage(state, "world", "base_link");
  EXPECT_EQ(message.header.frame_id, "world");
  EXPECT_EQ(message.child_frame_id, "base_link");
  EXPECT_EQ(message.pose.pose.position.y, 2.0);
  EXPECT_NEAR(message.twist.twist.linear.x, 0.7, 1e-12);
  EXPECT_NEAR(message.twist.twist.linear.y, 0.0, 1e-12);
  EXPECT_EQ(message.twist.twist.angular.z, 0.2);
}

TEST(LiveMessagesTest, TransformsLeadFromTheBaseToEachSensor) {
  const SimulationNodeConfig config;
  const auto transforms = StaticTransforms(config);
  ASSERT_EQ(transforms.size(), 4U);
  const SensorRig rig = MakeRig(config.simulation.suite);
  EXPECT_EQ(transforms[0].child_frame_id, "imu_link");
  EXPECT_LT((FromRos(transforms[0].transform).matrix() - rig.T_base_imu.matrix()).norm(), 1e-9);
  EXPECT_EQ(transforms[1].child_frame_id, "lidar_link");
  EXPECT_LT((FromRos(transforms[1].transform).matrix() - rig.T_base_lidar.matrix()).norm(), 1e-9);
  EXPECT_EQ(transforms[2].child_frame_id, "camera_link");
  EXPECT_EQ(transforms[3].header.frame_id, "camera_link");
  // The optical axis looks ahead and down.
  const Pose T_base_optical = FromRos(transforms[2].transform) * FromRos(transforms[3].transform);
  const Vector3d view = T_base_optical.linear().col(2);
  EXPECT_NEAR(std::asin(-view.z()) * 180.0 / M_PI, 17.5, 0.01);
  EXPECT_NEAR(view.y(), 0.0, 1e-9);
  EXPECT_GT(view.x(), 0.9);
  EXPECT_LT(T_base_optical.linear()(2, 1), -0.9);  // y points down
}

TEST(LiveMessagesTest, CollisionsAreNamed) {
  Contact contact;
  contact.velocity.linear_mps = 0.3;
  EXPECT_EQ(KindOf(contact), "obstacle");
  contact.kind = ContactKind::kPerson;
  EXPECT_EQ(KindOf(contact), "person");
  contact.velocity = {};
  EXPECT_EQ(KindOf(contact), "hit_by_person");
  contact.kind = ContactKind::kEdge;
  EXPECT_EQ(KindOf(contact), "edge");
}

}  // namespace
}  // namespace hv::sim
