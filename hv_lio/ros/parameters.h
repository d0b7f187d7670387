#pragma once

#include <string>

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include "hv_lio/system_config.h"

namespace YAML {
class Node;
}

namespace hv::lio {

/// Everything the node is told through ROS parameters.
struct NodeParameters {
  SystemConfig config;
  std::string save_trajectory;  ///< TUM file written at exit, empty for none
};

/// A parameter tree as YAML, so that one reader serves files and the parameter server alike. Dates
/// and binary values become their XML-RPC text, which no configuration field accepts.
YAML::Node ToYamlNode(XmlRpc::XmlRpcValue value);

/// Reads the private parameters of a node: first the file named by `~config_file`, if any, then
/// the other parameters, laid out as in the file (`~odometry/map/...`), on top. Throws InputError
/// with every problem of both.
NodeParameters ReadParameters(const ros::NodeHandle& private_nh);

}  // namespace hv::lio
