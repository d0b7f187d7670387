#pragma once

#include <string>

#include <ros/node_handle.h>

#include "hv_lio/system_config.h"

namespace hv::lio {

/// Everything the node is told through ROS parameters.
struct NodeParameters {
  SystemConfig config;
  std::string save_trajectory;  ///< TUM file written at exit, empty for none
};

/// Reads the private parameters of the node. Throws InputError with every problem of them.
NodeParameters ReadParameters(const ros::NodeHandle& private_nh);

}  // namespace hv::lio
