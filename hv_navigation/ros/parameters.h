#pragma once

#include <optional>
#include <string>

#include <ros/node_handle.h>

#include "hv_core/occupancy_grid.h"
#include "hv_navigation/navigation_config.h"

namespace hv::navigation {

/// Everything the node is told through ROS parameters.
struct NodeParameters {
  NavigationConfig config;
  std::string map_path;     ///< map folder or YAML of a grid, absolute; empty: the grid grows
  std::string save_folder;  ///< for the service `~save_map`, absolute; empty: it refuses
};

/// Reads the private parameters of the node. Throws InputError with every problem of them.
NodeParameters ReadParameters(const ros::NodeHandle& private_nh);

/// The grid of a map; nothing for an empty path. Throws InputError saying what is wrong with it.
std::optional<OccupancyGrid> ReadPriorGrid(const std::string& map_path);

}  // namespace hv::navigation
