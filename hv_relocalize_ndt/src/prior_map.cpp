#include "hv_relocalize_ndt/prior_map.h"

#include <map>
#include <utility>

#include "hv_core/error.h"

namespace hv::relocalize {
namespace {

/// Of the tilt up to which a pose that descriptors propose agrees with gravity.
constexpr double kUprightCosine = 0.97;

}  // namespace

PriorMap PriorMap::Load(const std::string& path, const RelocalizeConfig& config) {
  const MapFolder folder = MapFolder::Open(path);
  std::vector<Eigen::Vector3f> points;
  for (const Point& point : folder.ReadCloud().points) {
    points.emplace_back(point.x, point.y, point.z);
  }
  if (points.empty()) throw InputError(path + ": the cloud of the map is empty");
  PriorMap map(path, std::move(points), config);
  const MapContents contents = folder.contents();
  if (contents.graph && contents.descriptors) map.UseSession(loop::LoadSession(folder));
  return map;
}

PriorMap::PriorMap(std::string name, std::vector<Eigen::Vector3f> points,
                   const RelocalizeConfig& config)
    : name_(std::move(name)), points_(std::move(points)), config_(config) {
  for (const double resolution_m : config.ndt.resolutions_m) {
    levels_.emplace_back(resolution_m, points_);
  }
  surfaces_ = std::make_unique<NdtLevel>(config.search.cell_m, points_);
  structure_ = std::make_unique<StructureGrid>(*surfaces_, config.search.depth);
}

void PriorMap::UseSession(loop::SavedSession session) {
  descriptors_ = std::make_unique<loop::BtcDatabase>(config_.btc);
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
  loop::BtcExtractor extractor(config_.btc);
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
  for (const NdtLevel& level : levels_) levels.push_back(&level);
  return levels;
}

}  // namespace hv::relocalize
