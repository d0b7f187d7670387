#pragma once

#include <functional>
#include <vector>

#include "hv_core/config.h"
#include "hv_loop_btc/btc_database.h"
#include "hv_loop_btc/btc_descriptor.h"
#include "hv_loop_btc/loop_candidate.h"
#include "hv_loop_btc/loop_gate.h"
#include "hv_loop_btc/submap.h"
#include "hv_loop_btc/submap_registration.h"

namespace hv::loop {

struct StoredSubmaps;

struct LoopDetectorConfig {
  int max_entries = 40;
  int max_alignments = 8;
  double exclude_m = 15.0;
  double min_plane_overlap = 0.25;
  double min_score = 0.15;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// What is stored of a submap beside its descriptor: no cloud.
struct SubmapRecord {
  std::uint32_t keyframe = 0;
  Time stamp;
  std::vector<SubmapMember> members;
  double travelled_m = 0.0;  ///< of the odometry, from the start
};

/// What is believed before a submap is looked at.
struct LoopPrior {
  std::function<Pose(std::uint32_t)> T_map_keyframe;  ///< of stored submaps' keyframes
  Pose T_map_query = Pose::Identity();                ///< where odometry leads
  double travelled_m = 0.0;                           ///< at the query
  double travelled_at_loop_m = 0.0;                   ///< at the newest keyframe that a loop holds
};

/// Finds stored submaps that show the place of a new one: descriptors propose, planes pick, fine
/// alignment measures (methods section 2, steps 5-7). Which of the candidates are loops is for
/// LoopVote to say. Not thread-safe.
class LoopDetector {
 public:
  /// Gives back the cloud of a stored submap, in its frame.
  using CloudSource = std::function<std::vector<Eigen::Vector3f>(const SubmapRecord&)>;

  LoopDetector(const LoopDetectorConfig& config, const BtcConfig& btc,
               const RegistrationConfig& registration, const LoopGateConfig& gate,
               CloudSource clouds);

  /// Durations of the last Detect [ms].
  struct Timing {
    double extract_ms = 0.0;
    double query_ms = 0.0;
    double align_ms = 0.0;
  };

  /// Candidates for `submap`, best first; then stores it.
  std::vector<LoopCandidate> Detect(const Submap& submap, const LoopPrior& prior);

  /// Takes over the submaps of a saved map, before the first submap of its own.
  void Restore(const StoredSubmaps& submaps);

  /// How far two submaps of a loop may be apart [m].
  double loop_distance_m() const { return extractor_.scale().loop_distance_m; }
  /// Mean score that loops need while odometry is uncertain.
  double confirm_score() const { return extractor_.scale().confirm_score; }
  const Timing& timing() const { return timing_; }
  const BtcDatabase& database() const { return database_; }
  const std::vector<SubmapRecord>& records() const { return records_; }
  /// indoor, outdoor, or auto before the first submap.
  const std::string& scale_name() const { return extractor_.scale_name(); }

 private:
  std::vector<LoopCandidate> Propose(const BtcDescriptor& descriptor, const Submap& submap,
                                     const LoopPrior& prior) const;
  BtcDatabase::Filter FilterFor(const LoopPrior& prior) const;
  DriftLimits LimitsFor(const SubmapRecord& record, const LoopPrior& prior) const;
  void Align(const Submap& submap, LoopCandidate& candidate) const;
  const SubmapRecord& RecordOf(std::uint32_t keyframe) const;

  LoopDetectorConfig config_;
  LoopGate gate_;
  BtcExtractor extractor_;
  BtcDatabase database_;
  SubmapRegistration registration_;
  CloudSource clouds_;
  std::vector<SubmapRecord> records_;  ///< one an entry of the database
  Timing timing_;
};

}  // namespace hv::loop
