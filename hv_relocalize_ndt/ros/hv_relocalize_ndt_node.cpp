#include <iostream>

#include <ros/ros.h>

#include "hv_core/error.h"
#include "hv_core/memory.h"
#include "localization_node.h"

int main(int argc, char** argv) {
  hv::KeepFreedMemory();
  ros::init(argc, argv, "hv_relocalize_ndt");
  try {
    const hv::relocalize::LocalizationNode node(ros::NodeHandle(), ros::NodeHandle("~"));
    ros::spin();
  } catch (const hv::InputError& error) {
    // The last node handle is gone here and has taken rosconsole with it.
    std::cerr << "hv_relocalize_ndt cannot start:\n" << error.what() << std::endl;
    return 1;
  }
  return 0;
}
