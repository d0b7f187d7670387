#include "session_search.h"

#include <algorithm>

#include "hv_core/point_cloud_file.h"

namespace hv::loop {
namespace {

LoopGateConfig GateFor(LoopGateConfig config, SessionSearch::Guess guess) {
  if (guess == SessionSearch::Guess::kNear) return config;
  constexpr double kEverywhere = 1e6;
  config.base_translation_m = kEverywhere;
  config.base_vertical_m = kEverywhere;
  config.base_rotation_deg = 180.0;
  return config;
}

/// Without a guess every submap has false candidates by the dozen, and aligning them takes nearly
/// all of the time; the true one is among the first.
LoopDetectorConfig DetectorFor(LoopDetectorConfig config, SessionSearch::Guess guess) {
  constexpr int kMostAlignments = 3;
  if (guess == SessionSearch::Guess::kNone) {
    config.max_alignments = std::min(config.max_alignments, kMostAlignments);
  }
  return config;
}

}  // namespace

SessionSearch::SessionSearch(const LoopConfig& config, const SavedSession& map,
                             const SavedSession& added, Guess guess)
    : config_(config),
      map_(map),
      added_(added),
      detector_(DetectorFor(config.detector, guess), config.btc, config.registration,
                GateFor(config.gate, guess), [this](const SubmapRecord& record) {
                  return SubmapCloud(
                      record.members, [this](std::uint32_t id) { return PointsOf(id); },
                      config_.submap.leaf_m);
                }) {
  detector_.Restore(map.submaps);
}

/// The detector counts every submap that it was asked for among its own. All of the added session
/// are given the same way travelled, beyond that of the map: so they are too recent for each other,
/// and none of the map is.
std::vector<LoopCandidate> SessionSearch::Find(const SubmapRecord& record, const Poses& poses) {
  LoopPrior prior;
  prior.T_map_keyframe = poses;
  prior.T_map_query = poses(record.keyframe);
  prior.travelled_m =
      map_.submaps.records.back().travelled_m + 2.0 * config_.detector.exclude_m + 1.0;
  prior.travelled_at_loop_m = prior.travelled_m;
  Submap submap;
  submap.keyframe = record.keyframe;
  submap.stamp = record.stamp;
  submap.up = prior.T_map_query.linear().transpose() * Eigen::Vector3d::UnitZ();
  submap.members = record.members;
  submap.points = SubmapCloud(
      record.members, [this](std::uint32_t id) { return PointsOf(id); }, config_.submap.leaf_m);
  std::vector<LoopCandidate> candidates = detector_.Detect(submap, prior);
  const auto is_own = [this](const LoopCandidate& candidate) { return !InMap(candidate.match); };
  candidates.erase(std::remove_if(candidates.begin(), candidates.end(), is_own), candidates.end());
  return candidates;
}

const BtcDescriptor& SessionSearch::descriptor() const {
  return detector_.database().entry(detector_.database().size() - 1);
}

std::vector<Point> SessionSearch::PointsOf(std::uint32_t keyframe) const {
  return ReadPointCloud((InMap(keyframe) ? map_ : added_).clouds.at(keyframe)).points;
}

}  // namespace hv::loop
