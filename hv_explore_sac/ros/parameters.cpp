#include "parameters.h"

#include "hv_ros/parameters.h"

namespace hv::explore {

NodeParameters ReadParameters(const ros::NodeHandle& private_nh) {
  ExplorationNodeConfig config;
  PrivateParameters(private_nh).Read(config);
  return {config.exploration, config.navigation.planning.footprint.InscribedRadius()};
}

}  // namespace hv::explore
