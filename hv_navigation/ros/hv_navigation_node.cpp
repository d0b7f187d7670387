#include <csignal>
#include <ctime>
#include <iostream>

#include <ros/ros.h>

#include "hv_core/error.h"
#include "hv_core/memory.h"
#include "navigation_node.h"

namespace {

/// Returns after an interrupt, or when ROS has ended. Unlike the handler of ROS it leaves topics
/// open, so that the robot can be stopped.
void WaitForEnd(const sigset_t& signals) {
  const timespec patience{0, 100'000'000};
  while (ros::ok() && sigtimedwait(&signals, nullptr, &patience) < 0) {
  }
}

}  // namespace

int main(int argc, char** argv) {
  hv::KeepFreedMemory();
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  ros::init(argc, argv, "hv_navigation", ros::init_options::NoSigintHandler);
  try {
    // The connections outlive the node, so that its last velocity is delivered.
    const ros::NodeHandle connections;
    ros::AsyncSpinner spinner(1);
    {
      const hv::navigation::NavigationNode node(ros::NodeHandle(), ros::NodeHandle("~"));
      spinner.start();
      WaitForEnd(signals);
    }
    ros::WallDuration(0.1).sleep();
  } catch (const hv::InputError& error) {
    // The last node handle is gone here and has taken rosconsole with it.
    std::cerr << "hv_navigation cannot start:\n" << error.what() << std::endl;
    return 1;
  }
  return 0;
}
