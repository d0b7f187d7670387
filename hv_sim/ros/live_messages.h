#pragma once

#include <string>
#include <vector>

#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "hv_sim/live_simulation.h"
#include "parameters.h"

/// What the simulation says, as ROS messages. All functions are pure.
namespace hv::sim {

/// 16UC1 in mm; 0: unknown.
sensor_msgs::Image ToImageMessage(const DepthImage& image, const std::string& frame);

/// A camera without distortion.
sensor_msgs::CameraInfo ToCameraInfo(const DepthCameraConfig& camera, Time stamp,
                                     const std::string& frame);

/// Pose of the base in the world; twist in the base frame.
nav_msgs::Odometry ToOdometryMessage(const TrueState& state, const std::string& world_frame,
                                     const std::string& base_frame);

geometry_msgs::TransformStamped ToTransformMessage(const TrueState& state,
                                                   const std::string& world_frame,
                                                   const std::string& base_frame);

/// obstacle, person, hit_by_person (while it stood) or edge.
std::string KindOf(const Contact& contact);

/// Where the sensors sit on the robot.
std::vector<geometry_msgs::TransformStamped> StaticTransforms(const SimulationNodeConfig& config);

}  // namespace hv::sim
