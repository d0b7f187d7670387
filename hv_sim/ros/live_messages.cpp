#include "live_messages.h"

#include <cstring>

#include "hv_ros/conversions.h"

namespace hv::sim {
namespace {

geometry_msgs::TransformStamped ToStamped(const Pose& T_parent_child, const std::string& parent,
                                          const std::string& child) {
  geometry_msgs::TransformStamped message;
  message.header.frame_id = parent;
  message.child_frame_id = child;
  message.transform = ToTransform(T_parent_child);
  return message;
}

}  // namespace

sensor_msgs::Image ToImageMessage(const DepthImage& image, const std::string& frame) {
  sensor_msgs::Image message;
  message.header.stamp = ToRos(image.stamp);
  message.header.frame_id = frame;
  message.width = static_cast<std::uint32_t>(image.width);
  message.height = static_cast<std::uint32_t>(image.height);
  message.encoding = "16UC1";
  message.is_bigendian = 0;
  message.step = message.width * static_cast<std::uint32_t>(sizeof(std::uint16_t));
  message.data.resize(image.depth_mm.size() * sizeof(std::uint16_t));
  std::memcpy(message.data.data(), image.depth_mm.data(), message.data.size());
  return message;
}

sensor_msgs::CameraInfo ToCameraInfo(const DepthCameraConfig& camera, Time stamp,
                                     const std::string& frame) {
  sensor_msgs::CameraInfo info;
  info.header.stamp = ToRos(stamp);
  info.header.frame_id = frame;
  info.width = static_cast<std::uint32_t>(camera.width);
  info.height = static_cast<std::uint32_t>(camera.height);
  info.distortion_model = "plumb_bob";
  info.D.assign(5, 0.0);
  info.K = {camera.fx(), 0.0, camera.cx(), 0.0, camera.fy(), camera.cy(), 0.0, 0.0, 1.0};
  info.R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  info.P = {camera.fx(), 0.0, camera.cx(), 0.0, 0.0, camera.fy(),
            camera.cy(), 0.0, 0.0,         0.0, 1.0, 0.0};
  return info;
}

nav_msgs::Odometry ToOdometryMessage(const TrueState& state, const std::string& world_frame,
                                     const std::string& base_frame) {
  const MotionState& base = state.base;
  nav_msgs::Odometry message;
  message.header.stamp = ToRos(state.stamp);
  message.header.frame_id = world_frame;
  message.child_frame_id = base_frame;
  message.pose.pose = ToPoseMessage(base.T_world_body);
  message.twist.twist.linear =
      ToVectorMessage(base.T_world_body.linear().transpose() * base.velocity);
  message.twist.twist.angular = ToVectorMessage(base.angular_velocity);
  return message;
}

geometry_msgs::TransformStamped ToTransformMessage(const TrueState& state,
                                                   const std::string& world_frame,
                                                   const std::string& base_frame) {
  auto message = ToStamped(state.base.T_world_body, world_frame, base_frame);
  message.header.stamp = ToRos(state.stamp);
  return message;
}

std::string KindOf(const Contact& contact) {
  if (contact.kind == ContactKind::kObstacle) return "obstacle";
  if (contact.kind == ContactKind::kEdge) return "edge";
  const bool stood = contact.velocity.linear_mps == 0.0 && contact.velocity.angular_rps == 0.0;
  return stood ? "hit_by_person" : "person";
}

std::vector<geometry_msgs::TransformStamped> StaticTransforms(const SimulationNodeConfig& config) {
  const SensorRig rig = MakeRig(config.simulation.suite);
  return {ToStamped(rig.T_base_imu, config.base_frame, config.imu_frame),
          ToStamped(rig.T_base_lidar, config.base_frame, config.lidar_frame),
          ToStamped(config.simulation.camera.mounting(), config.base_frame, config.camera_frame),
          ToStamped(OpticalInCamera(), config.camera_frame, config.optical_frame)};
}

}  // namespace hv::sim
