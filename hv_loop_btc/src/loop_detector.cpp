#include "hv_loop_btc/loop_detector.h"

#include <algorithm>
#include <chrono>

#include "hv_loop_btc/plane_overlap.h"
#include "hv_loop_btc/submap_file.h"

namespace hv::loop {
namespace {

/// Candidates whose poses in the map are this close follow from the same hypothesis.
constexpr double kSamePlace_m = 0.7;
constexpr double kSameHeading = 0.1;
/// Submaps of the same passage, whatever the distance.
constexpr std::size_t kRecentSubmaps = 6;

class Stopwatch {
 public:
  double Lap() {
    const auto now = std::chrono::steady_clock::now();
    const double elapsed = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return elapsed;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace

void LoopDetectorConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("max_entries", max_entries, "stored submaps that are looked at for a new one");
  visitor.Field("max_alignments", max_alignments, "of these, how many are finely aligned");
  visitor.Field("exclude_m", exclude_m, "way back that is too recent for a loop [m]");
  visitor.Field("min_plane_overlap", min_plane_overlap,
                "share of planes that must fit before a fine alignment, 0 to 1");
  visitor.Field(
      "min_score", min_score,
      "score that a loop needs after the fine alignment: fitness times overlap, less where "
      "one submap sees through the other, 0 to 1");
}

void LoopDetectorConfig::Validate(ConfigProblems& problems) const {
  problems.Require(max_entries >= 1, "detector.max_entries", "must be at least 1");
  problems.Require(max_alignments >= 1, "detector.max_alignments", "must be at least 1");
  problems.Require(exclude_m >= 0.0, "detector.exclude_m", "must not be negative");
  problems.Require(min_plane_overlap >= 0.0 && min_plane_overlap <= 1.0,
                   "detector.min_plane_overlap", "must lie between 0 and 1");
  problems.Require(min_score >= 0.0 && min_score <= 1.0, "detector.min_score",
                   "must lie between 0 and 1");
}

LoopDetector::LoopDetector(const LoopDetectorConfig& config, const BtcConfig& btc,
                           const RegistrationConfig& registration, const LoopGateConfig& gate,
                           CloudSource clouds)
    : config_(config),
      gate_(gate),
      extractor_(btc),
      database_(btc),
      registration_(registration),
      clouds_(std::move(clouds)) {}

DriftLimits LoopDetector::LimitsFor(const SubmapRecord& record, const LoopPrior& prior) const {
  const double held = std::max(record.travelled_m, prior.travelled_at_loop_m);
  return gate_.LimitsAfter(std::max(0.0, prior.travelled_m - held));
}

BtcDatabase::Filter LoopDetector::FilterFor(const LoopPrior& prior) const {
  BtcDatabase::Filter filter;
  filter.entry = [this, &prior](std::size_t entry) {
    const SubmapRecord& record = records_[entry];
    const bool recent = entry + kRecentSubmaps >= records_.size() ||
                        record.travelled_m > prior.travelled_m - config_.exclude_m;
    if (recent) return false;
    const DriftLimits limits = LimitsFor(record, prior);
    const Eigen::Vector3d offset =
        prior.T_map_query.translation() - prior.T_map_keyframe(record.keyframe).translation();
    return offset.norm() < loop_distance_m() + limits.translation_m &&
           std::abs(offset.z()) < loop_distance_m() + limits.vertical_m;
  };
  filter.pose = [this, &prior](std::size_t entry, const Pose& T_entry_query) {
    const SubmapRecord& record = records_[entry];
    return T_entry_query.translation().norm() < 1.2 * loop_distance_m() &&
           LoopGate::Allows(prior.T_map_keyframe(record.keyframe) * T_entry_query,
                            prior.T_map_query, LimitsFor(record, prior));
  };
  return filter;
}

std::vector<LoopCandidate> LoopDetector::Propose(const BtcDescriptor& descriptor,
                                                 const Submap& submap,
                                                 const LoopPrior& prior) const {
  const BtcScale& scale = extractor_.scale();
  const auto found =
      database_.Query(descriptor, scale.vertex_tolerance_m,
                      static_cast<std::size_t>(config_.max_entries), FilterFor(prior));
  std::vector<LoopCandidate> candidates;
  for (const BtcCandidate& candidate : found) {
    const SubmapRecord& record = records_[candidate.entry];
    const PlaneIndex index(database_.entry(candidate.entry).planes, scale.plane_voxel_m);
    LoopCandidate loop;
    loop.query = submap.keyframe;
    loop.match = record.keyframe;
    loop.query_stamp = submap.stamp;
    loop.match_stamp = record.stamp;
    loop.T_match_query = candidate.T_entry_query;
    loop.votes = candidate.votes;
    loop.inliers = candidate.inliers;
    loop.plane_overlap =
        index.Overlap(descriptor.planes, candidate.T_entry_query, scale.plane_distance_m);
    candidates.push_back(loop);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const LoopCandidate& a, const LoopCandidate& b) {
                     return a.plane_overlap > b.plane_overlap;
                   });
  return candidates;
}

const SubmapRecord& LoopDetector::RecordOf(std::uint32_t keyframe) const {
  return *std::lower_bound(
      records_.begin(), records_.end(), keyframe,
      [](const SubmapRecord& record, std::uint32_t id) { return record.keyframe < id; });
}

void LoopDetector::Align(const Submap& submap, LoopCandidate& candidate) const {
  const RegistrationResult aligned = registration_.Align(
      clouds_(RecordOf(candidate.match)), submap.points, submap.up, candidate.T_match_query);
  candidate.T_match_query = aligned.T_target_source;
  candidate.fitness = aligned.fitness;
  candidate.overlap = aligned.overlap;
  candidate.seen_through = aligned.seen_through;
  if (aligned.seen_through > registration_.config().max_seen_through) {
    candidate.reason = "one submap sees through the other";
  } else if (!aligned.converged) {
    candidate.reason = "fine alignment does not converge";
  } else if (aligned.fitness < registration_.config().min_fitness ||
             candidate.score() < config_.min_score) {
    candidate.reason = "submaps do not fit";
  } else if (candidate.T_match_query.translation().norm() > loop_distance_m()) {
    candidate.reason = "places are too far apart";
  }
}

void LoopDetector::Restore(const StoredSubmaps& submaps) {
  extractor_.SetScale(submaps.scale);
  records_ = submaps.records;
  for (const BtcDescriptor& descriptor : submaps.descriptors) database_.Add(descriptor);
}

std::vector<LoopCandidate> LoopDetector::Detect(const Submap& submap, const LoopPrior& prior) {
  Stopwatch watch;
  BtcDescriptor descriptor = extractor_.Extract(submap);
  timing_.extract_ms = watch.Lap();
  std::vector<LoopCandidate> candidates = Propose(descriptor, submap, prior);
  timing_.query_ms = watch.Lap();
  std::vector<Pose> aligned;
  int alignments = 0;
  for (LoopCandidate& candidate : candidates) {
    const Pose T_map_match = prior.T_map_keyframe(candidate.match);
    const Pose place = T_map_match * candidate.T_match_query;
    const bool known = std::any_of(aligned.begin(), aligned.end(), [&](const Pose& other) {
      return (place.translation() - other.translation()).norm() < kSamePlace_m &&
             RotationDistance(place, other) < kSameHeading;
    });
    if (candidate.plane_overlap < config_.min_plane_overlap) {
      candidate.reason = "planes do not overlap";
    } else if (known) {
      candidate.reason = "same hypothesis as a better candidate";
    } else if (++alignments > config_.max_alignments) {
      candidate.reason = "not among the best";
    } else {
      Align(submap, candidate);
      if (candidate.reason.empty()) aligned.push_back(T_map_match * candidate.T_match_query);
    }
  }
  timing_.align_ms = watch.Lap();
  records_.push_back({submap.keyframe, submap.stamp, submap.members, prior.travelled_m});
  database_.Add(std::move(descriptor));
  return candidates;
}

}  // namespace hv::loop
