#include "parameters.h"

#include <filesystem>

#include "hv_core/error.h"
#include "hv_core/map_folder.h"
#include "hv_ros/parameters.h"

namespace hv::navigation {

NodeParameters ReadParameters(const ros::NodeHandle& private_nh) {
  PrivateParameters source(private_nh);
  NodeParameters parameters;
  parameters.map_path = source.TakePath("map");
  parameters.save_folder = source.TakePath("save_folder");
  NavigationNodeConfig config;
  source.Read(config);
  parameters.config = config.navigation;
  return parameters;
}

std::optional<OccupancyGrid> ReadPriorGrid(const std::string& map_path) {
  if (map_path.empty()) return std::nullopt;
  const std::string extension = std::filesystem::path(map_path).extension();
  if (extension == ".yaml" || extension == ".yml") return ReadGrid(map_path);
  const MapFolder folder = MapFolder::Open(map_path);
  if (!folder.contents().grid) throw InputError(map_path + ": the map has no grid to plan in");
  return folder.ReadGrid();
}

}  // namespace hv::navigation
