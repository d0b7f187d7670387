#pragma once

#include <string>

#include <ros/node_handle.h>

#include "hv_sim/live_config.h"

namespace hv::sim {

/// How the simulation node runs, and what it calls its frames.
struct SimulationNodeConfig {
  LiveConfig simulation;
  double rate = 1.0;  ///< simulated seconds per second; 0: as fast as possible
  int threads = 1;    ///< that cast rays
  bool publish_static_tf = true;
  bool publish_truth_tf = false;  ///< for rviz, while nobody else places the base
  std::string world_frame = "world";
  std::string base_frame = "base_link";
  std::string imu_frame = "imu_link";
  std::string lidar_frame = "lidar_link";
  std::string camera_frame = "camera_link";
  std::string optical_frame = "camera_depth_optical_frame";

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Reads the private parameters of the node. Throws InputError with every problem of them.
SimulationNodeConfig ReadParameters(const ros::NodeHandle& private_nh);

}  // namespace hv::sim
