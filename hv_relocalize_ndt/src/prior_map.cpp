#include "hv_relocalize_ndt/prior_map.h"

#include <utility>

#include "hv_core/error.h"

namespace hv::relocalize {

PriorMap PriorMap::Load(const std::string& path, const RelocalizeConfig& config) {
  const MapFolder folder = MapFolder::Open(path);
  std::vector<Eigen::Vector3f> points;
  for (const Point& point : folder.ReadCloud().points) {
    points.emplace_back(point.x, point.y, point.z);
  }
  if (points.empty()) throw InputError(path + ": the cloud of the map is empty");
  PriorMap map(path, std::move(points), config);
  const MapContents contents = folder.contents();
  if (contents.graph && contents.descriptors) map.session_ = loop::LoadSession(folder);
  return map;
}

PriorMap::PriorMap(std::string name, std::vector<Eigen::Vector3f> points,
                   const RelocalizeConfig& config)
    : name_(std::move(name)), points_(std::move(points)) {
  for (const double resolution_m : config.ndt.resolutions_m) {
    levels_.emplace_back(resolution_m, points_);
  }
  surfaces_ = std::make_unique<NdtLevel>(config.search.cell_m, points_);
  structure_ = std::make_unique<StructureGrid>(*surfaces_, config.search.depth);
}

std::vector<const NdtLevel*> PriorMap::Levels() const {
  std::vector<const NdtLevel*> levels;
  for (const NdtLevel& level : levels_) levels.push_back(&level);
  return levels;
}

}  // namespace hv::relocalize
