#pragma once

#include <string>

#include <ros/node_handle.h>

#include "hv_loop_btc/mapping_config.h"

namespace hv::loop {

/// Everything the node is told through ROS parameters.
struct NodeParameters {
  MappingConfig config;
  std::string map_path;      ///< map folder to save to, absolute; empty: only where asked to
  std::string continue_map;  ///< saved map to go on from, absolute; empty: a new map

  /// Folder of the working files: beside the map, so that saving can link instead of copying, or
  /// a temporary one of this process.
  std::string WorkFolder() const;
};

/// Reads the private parameters of the node. Throws InputError with every problem of them.
NodeParameters ReadParameters(const ros::NodeHandle& private_nh);

}  // namespace hv::loop
