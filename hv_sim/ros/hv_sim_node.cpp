#include <iostream>

#include <ros/ros.h>

#include "hv_core/error.h"
#include "hv_core/memory.h"
#include "simulation_node.h"

int main(int argc, char** argv) {
  hv::KeepFreedMemory();
  ros::init(argc, argv, "hv_sim");
  try {
    const hv::sim::SimulationNode node(ros::NodeHandle(), ros::NodeHandle("~"));
    ros::spin();
  } catch (const hv::InputError& error) {
    // The last node handle is gone here and has taken rosconsole with it.
    std::cerr << "hv_sim cannot start:\n" << error.what() << std::endl;
    return 1;
  }
  return 0;
}
