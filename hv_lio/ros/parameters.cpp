#include "parameters.h"

#include "hv_ros/parameters.h"

namespace hv::lio {

NodeParameters ReadParameters(const ros::NodeHandle& private_nh) {
  PrivateParameters source(private_nh);
  NodeParameters parameters;
  parameters.save_trajectory = source.TakeString("save_trajectory");
  source.Read(parameters.config);
  return parameters;
}

}  // namespace hv::lio
