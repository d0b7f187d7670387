#pragma once

#include <ros/node_handle.h>

#include "hv_explore_sac/explorer_config.h"

namespace hv::explore {

/// Everything the node is told through ROS parameters.
struct NodeParameters {
  RobotExplorationConfig config;
  double robot_radius_m = 0.0;  ///< of the largest circle in the footprint
};

/// Reads the private parameters of the node. Throws InputError with every problem of them.
NodeParameters ReadParameters(const ros::NodeHandle& private_nh);

}  // namespace hv::explore
