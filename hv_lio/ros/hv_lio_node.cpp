#include <ros/ros.h>

#include "hv_core/error.h"
#include "odometry_node.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "hv_lio");
  try {
    const hv::lio::OdometryNode node(ros::NodeHandle(), ros::NodeHandle("~"));
    ros::spin();
  } catch (const hv::InputError& error) {
    ROS_FATAL_STREAM("hv_lio cannot start:\n" << error.what());
    return 1;
  }
  return 0;
}
