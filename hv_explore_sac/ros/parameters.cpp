#include "parameters.h"

#include "hv_ros/parameters.h"

namespace hv::explore {

NodeParameters ReadParameters(const ros::NodeHandle& private_nh) {
  ExplorationNodeConfig config;
  PrivateParameters(private_nh).Read(config);
  const navigation::Footprint& footprint = config.navigation.planning.footprint;
  return {config.exploration, {footprint.InscribedRadius(), footprint.CircumscribedRadius()}};
}

}  // namespace hv::explore
