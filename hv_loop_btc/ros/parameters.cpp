#include "parameters.h"

#include <unistd.h>

#include <filesystem>

#include "hv_ros/parameters.h"

namespace hv::loop {
namespace {

namespace fs = std::filesystem;

std::string WithoutTrailingSlash(std::string path) {
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  return path;
}

}  // namespace

std::string NodeParameters::WorkFolder() const {
  const fs::path map = map_path;
  if (!map_path.empty()) {
    return map.parent_path() / ("." + map.filename().string() + ".keyframes");
  }
  std::error_code ignored;
  const fs::path temporary = fs::temp_directory_path(ignored);
  return temporary / ("hv_loop_btc-" + std::to_string(getpid()));
}

NodeParameters ReadParameters(const ros::NodeHandle& private_nh) {
  PrivateParameters source(private_nh);
  NodeParameters parameters;
  parameters.map_path = WithoutTrailingSlash(source.TakePath("map_path"));
  parameters.continue_map = source.TakePath("continue_map");
  source.Read(parameters.config);
  return parameters;
}

}  // namespace hv::loop
