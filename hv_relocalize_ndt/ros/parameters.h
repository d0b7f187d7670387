#pragma once

#include <optional>
#include <string>

#include <ros/node_handle.h>

#include "hv_core/se3.h"
#include "hv_relocalize_ndt/localizer_config.h"

namespace hv::relocalize {

/// Everything the node is told through ROS parameters.
struct NodeParameters {
  LocalizerConfig config;
  std::string map_path;            ///< map folder, PCD or PLY, absolute
  std::optional<Pose> T_map_base;  ///< about where the robot is at the start
};

/// Reads the private parameters of the node. Throws InputError with every problem of them.
NodeParameters ReadParameters(const ros::NodeHandle& private_nh);

/// "x y z roll pitch yaw" [m, rad]; nothing for an empty text. Throws InputError for anything else.
std::optional<Pose> ParsePose(const std::string& text);

}  // namespace hv::relocalize
