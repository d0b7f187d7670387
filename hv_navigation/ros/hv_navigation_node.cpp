#include <iostream>

#include <ros/ros.h>

#include "hv_core/error.h"
#include "hv_core/memory.h"
#include "hv_ros/interrupt.h"
#include "navigation_node.h"

int main(int argc, char** argv) {
  hv::KeepFreedMemory();
  const hv::Interrupt interrupt;
  ros::init(argc, argv, "hv_navigation", ros::init_options::NoSigintHandler);
  try {
    // The connections outlive the node, so that its last velocity is delivered.
    const ros::NodeHandle connections;
    ros::AsyncSpinner spinner(1);
    {
      const hv::navigation::NavigationNode node(ros::NodeHandle(), ros::NodeHandle("~"));
      spinner.start();
      interrupt.Wait();
    }
    ros::WallDuration(0.1).sleep();
  } catch (const hv::InputError& error) {
    // The last node handle is gone here and has taken rosconsole with it.
    std::cerr << "hv_navigation cannot start:\n" << error.what() << std::endl;
    return 1;
  }
  return 0;
}
