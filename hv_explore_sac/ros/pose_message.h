#pragma once

#include <string>

#include <geometry_msgs/PoseStamped.h>

#include "hv_navigation/planar.h"
#include "hv_ros/conversions.h"

namespace hv::explore {

/// On the plane z = 0 of a frame; the stamp is now.
inline geometry_msgs::PoseStamped ToPoseStamped(const navigation::PlanarPose& pose,
                                                const std::string& frame) {
  const Eigen::Vector3d position(pose.position.x(), pose.position.y(), 0.0);
  geometry_msgs::PoseStamped message;
  message.header.frame_id = frame;
  message.header.stamp = ros::Time::now();
  message.pose = ToPoseMessage(MakePose(RotationFromRpy(0.0, 0.0, pose.yaw), position));
  return message;
}

}  // namespace hv::explore
