#pragma once

#include <ros/node_handle.h>

#include "hv_explore_sac/explorer_config.h"
#include "hv_explore_sac/known_place.h"

namespace hv::explore {

/// Everything the node is told through ROS parameters.
struct NodeParameters {
  RobotExplorationConfig config;
  RobotSize size;
};

/// Reads the private parameters of the node. Throws InputError with every problem of them.
NodeParameters ReadParameters(const ros::NodeHandle& private_nh);

}  // namespace hv::explore
