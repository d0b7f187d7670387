#include "hv_relocalize_ndt/prior_map.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "hv_core/error.h"
#include "hv_relocalize_ndt/ndt_cache.h"

namespace hv::relocalize {
namespace {

/// Of the tilt up to which a pose that descriptors propose agrees with gravity.
constexpr double kUprightCosine = 0.97;
/// Levels finer than this refine a pose that is roughly known [m].
constexpr double kFineLevel_m = 4.0;

/// Those of the alignment, then that of the surfaces.
std::vector<double> ResolutionsOf(const RelocalizeConfig& config) {
  std::vector<double> resolutions_m = config.ndt.resolutions_m;
  resolutions_m.push_back(config.search.cell_m);
  return resolutions_m;
}

/// Where a map keeps its levels, and what they are made of.
PriorMap::LevelFile LevelsIn(const MapFolder& folder, const RelocalizeConfig& config) {
  std::string key;
  for (const MapFile& file : folder.manifest().files) {
    if (file.name == "cloud.pcd") key = file.sha256;
  }
  for (const double resolution_m : ResolutionsOf(config)) {
    key += " " + std::to_string(resolution_m);
  }
  return {folder.path() + "/ndt.bin", key};
}

}  // namespace

PriorMap PriorMap::Load(const std::string& path, const RelocalizeConfig& config) {
  const MapFolder folder = MapFolder::Open(path);
  std::vector<Eigen::Vector3f> points;
  const PointCloud cloud = folder.ReadCloud();
  for (const Point& point : cloud.points) points.emplace_back(point.x, point.y, point.z);
  if (points.empty()) throw InputError(path + ": the cloud of the map is empty");
  if (folder.is_plain_cloud()) return PriorMap(path, std::move(points), config);
  PriorMap map(path, std::move(points), config, LevelsIn(folder, config));
  const MapContents contents = folder.contents();
  if (!contents.graph || !contents.descriptors) return map;
  const auto descriptors = loop::DescriptorConfigOf(folder.manifest());
  if (descriptors) map.UseSession(loop::LoadSession(folder), *descriptors);
  return map;
}

PriorMap::PriorMap(std::string name, std::vector<Eigen::Vector3f> points,
                   const RelocalizeConfig& config)
    : PriorMap(std::move(name), std::move(points), config, {}) {}

PriorMap::PriorMap(std::string name, std::vector<Eigen::Vector3f> points,
                   const RelocalizeConfig& config, const LevelFile& file)
    : name_(std::move(name)), points_(std::move(points)), config_(config) {
  std::optional<std::vector<NdtLevel>> stored;
  if (!file.path.empty()) stored = ReadLevels(file.path, file.key);
  if (stored) {
    levels_ = std::move(*stored);
  } else {
    for (const double resolution_m : ResolutionsOf(config)) {
      levels_.emplace_back(resolution_m, points_);
    }
    if (!file.path.empty()) WriteLevels(file.path, levels_, file.key);
  }
  structure_ = std::make_unique<StructureGrid>(surfaces(), config.search.depth);
}

void PriorMap::UseSession(loop::SavedSession session, const loop::BtcConfig& config) {
  descriptor_config_ = config;
  descriptors_ = std::make_unique<loop::BtcDatabase>(config);
  std::map<std::uint32_t, Pose> poses;
  for (const GraphVertex& vertex : session.graph.vertices) poses[vertex.id] = vertex.T_map_imu;
  for (std::size_t i = 0; i < session.submaps.records.size(); ++i) {
    descriptors_->Add(session.submaps.descriptors[i]);
    T_map_submap_.push_back(poses.at(session.submaps.records[i].keyframe));
  }
  session_ = std::move(session);
}

std::vector<Pose> PriorMap::PlacesLike(const std::vector<Eigen::Vector3f>& points,
                                       const Eigen::Vector3d& up) const {
  if (!session_) return {};
  loop::Submap submap;
  submap.up = up;
  submap.points = points;
  loop::BtcExtractor extractor(descriptor_config_);
  extractor.SetScale(session_->submaps.scale);
  const loop::BtcDescriptor descriptor = extractor.Extract(submap);
  loop::BtcDatabase::Filter filter;
  filter.entry = [](std::size_t) { return true; };
  filter.pose = [&](std::size_t entry, const Pose& T_submap_scan) {
    const Eigen::Matrix3d rotation = T_map_submap_[entry].linear() * T_submap_scan.linear();
    return (rotation * up).z() > kUprightCosine;
  };
  std::vector<Pose> places;
  for (const loop::BtcCandidate& candidate :
       descriptors_->Query(descriptor, extractor.scale().vertex_tolerance_m,
                           static_cast<std::size_t>(config_.descriptor_candidates), filter)) {
    places.push_back(T_map_submap_[candidate.entry] * candidate.T_entry_query);
  }
  if (places.size() > static_cast<std::size_t>(config_.descriptor_candidates)) {
    places.resize(static_cast<std::size_t>(config_.descriptor_candidates));
  }
  return places;
}

std::vector<const NdtLevel*> PriorMap::Levels() const {
  std::vector<const NdtLevel*> levels;
  for (std::size_t i = 0; i + 1 < levels_.size(); ++i) levels.push_back(&levels_[i]);
  return levels;
}

std::vector<const NdtLevel*> PriorMap::FineLevels() const {
  std::vector<const NdtLevel*> levels = Levels();
  const auto coarse = [](const NdtLevel* level) { return level->resolution_m() >= kFineLevel_m; };
  levels.erase(levels.begin(), std::find_if_not(levels.begin(), std::prev(levels.end()), coarse));
  return levels;
}

}  // namespace hv::relocalize
