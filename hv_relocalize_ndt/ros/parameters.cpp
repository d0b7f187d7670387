#include "parameters.h"

#include <cmath>
#include <sstream>
#include <vector>

#include "hv_core/error.h"
#include "hv_ros/parameters.h"

namespace hv::relocalize {

std::optional<Pose> ParsePose(const std::string& text) {
  if (text.empty()) return std::nullopt;
  std::istringstream stream(text);
  std::vector<double> values;
  for (double value = 0.0; stream >> value;) values.push_back(value);
  if (!stream.eof() || values.size() != 6) {
    throw InputError("'" + text + "' is not \"x y z roll pitch yaw\", six numbers in m and rad");
  }
  return MakePose(RotationFromRpy(values[3], values[4], values[5]),
                  Eigen::Vector3d(values[0], values[1], values[2]));
}

NodeParameters ReadParameters(const ros::NodeHandle& private_nh) {
  PrivateParameters source(private_nh);
  NodeParameters parameters;
  parameters.map_path = source.TakePath("map");
  const std::string pose = source.TakeString("initial_pose");
  try {
    parameters.T_map_base = ParsePose(pose);
  } catch (const InputError& error) {
    throw InputError(private_nh.getNamespace() + "/initial_pose: " + error.what());
  }
  LocalizationNodeConfig config;
  source.Read(config);
  parameters.config = config.localization;
  if (parameters.map_path.empty()) {
    throw InputError(private_nh.getNamespace() + "/map: no map is given");
  }
  return parameters;
}

}  // namespace hv::relocalize
