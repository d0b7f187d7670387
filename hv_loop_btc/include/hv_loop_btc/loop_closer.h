#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hv_core/config.h"
#include "hv_core/keyframe.h"
#include "hv_core/keyframe_store.h"
#include "hv_loop_btc/loop_detector.h"
#include "hv_loop_btc/loop_vote.h"
#include "hv_loop_btc/odometry_edge.h"
#include "hv_loop_btc/odometry_model.h"
#include "hv_loop_btc/pose_graph.h"

namespace hv::loop {

struct StoredSubmaps;

/// Everything that loop closing can be told. Section `loop` of the configuration file.
struct LoopConfig {
  double loop_sigma_m = 0.05;
  double loop_sigma_deg = 0.5;
  SubmapConfig submap;
  BtcConfig btc;
  LoopDetectorConfig detector;
  RegistrationConfig registration;
  LoopGateConfig gate;
  LoopVoteConfig vote;
  OdometryEdgeConfig odometry;
  PoseGraphConfig graph;
  KeyframeStoreConfig store;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// The edge of a loop, from match to query: information by the score of the fit (Eq. 10).
GraphEdge LoopEdge(const LoopConfig& config, const LoopCandidate& loop);

/// What one keyframe led to.
struct LoopUpdate {
  std::vector<LoopCandidate>
      candidates;          ///< all looked at; no reason: accepted, or not decided yet
  bool optimized = false;  ///< the poses of earlier keyframes have moved
  PoseGraphSummary graph;  ///< of the last optimisation
  LoopDetector::Timing detection;
};

/// From keyframes of the odometry to a consistent map: submaps, loop candidates, pose graph (paper
/// 3.2). The offline tool and the node both drive this class. Clouds go to the store; what is kept
/// of a keyframe in memory is its pose, its edges and its share of a descriptor. Not thread-safe.
class LoopCloser {
 public:
  /// Throws InputError when the configuration is invalid. `store` must outlive this object.
  LoopCloser(const LoopConfig& config, KeyframeStore& store);

  /// Keyframes in order of time, ids growing.
  LoopUpdate Add(const Keyframe& keyframe);

  /// At the end of the data: takes the keyframes that are not yet in a submap, and gives the
  /// candidates that were never confirmed their reason.
  LoopUpdate Finish();

  /// Loads a saved map before the first keyframe and starts a session on top of it. Keyframes of
  /// the new session need ids above those of the map, and segments from the returned number on. See
  /// ContinueMap. Throws InputError.
  std::uint32_t Restore(const PoseGraphData& data, const StoredSubmaps& submaps);

  /// The odometry starts anew at an unknown place: later keyframes form a session of their own
  /// until loops join it to the earlier ones. T_map_odom() is the identity meanwhile.
  void StartSession();

  /// Whether the newest session has its place in the map: always, where nothing was before.
  bool Joined() const;

  /// Keyframes whose place in the map is known: all, once the newest session is joined.
  std::vector<GraphVertex> PlacedVertices() const;

  /// Pose of odom in map: carries odometry of the newest segment to the corrected map.
  Pose T_map_odom() const { return T_map_odom_; }

  /// Every loop candidate since the start.
  const std::vector<LoopCandidate>& candidates() const { return candidates_; }
  const PoseGraph& graph() const { return graph_; }
  const LoopDetector& detector() const { return detector_; }

  /// The submaps as bytes, to be stored with the map.
  std::string SerializedSubmaps() const;

  /// Pose in the map of an odometry pose at any time: carried by the keyframes before and after,
  /// and interpolated between the two.
  Pose Corrected(Time stamp, const Pose& T_odom_imu) const;

 private:
  void AddToGraph(const Keyframe& keyframe);
  LoopUpdate Process(const std::optional<Submap>& submap);
  LoopPrior Prior(const Submap& submap) const;
  std::vector<Eigen::Vector3f> CloudOf(const SubmapRecord& record) const;
  void AddLoop(const LoopCandidate& loop);
  void WeighOdometryAnew();
  void AddLoops(const std::vector<LoopCandidate>& loops);
  void TakeVerdicts(std::vector<LoopCandidate>& fresh);

  LoopConfig config_;
  KeyframeStore& store_;
  SubmapBuilder submaps_;
  LoopDetector detector_;
  LoopGate gate_;
  LoopVote vote_;
  OdometryModel odometry_model_;
  PoseGraph graph_;
  std::vector<GraphEdge> odometry_;  ///< as odometry says, with the noise assumed
  std::vector<LoopCandidate> candidates_;
  /// Of each keyframe: where odometry saw it, and the way until then.
  struct Track {
    Time stamp;
    Pose T_odom_imu = Pose::Identity();
    Eigen::Vector3d up_imu = Eigen::Vector3d::UnitZ();
    double travelled_m = 0.0;
    std::uint32_t segment = 0;
  };
  std::map<std::uint32_t, Track> tracks_;
  std::optional<Keyframe> last_;  ///< without points
  double travelled_at_loop_m_ = 0.0;
  std::uint32_t session_start_ = 0;   ///< id from which keyframes belong to the newest session
  double session_travelled_m_ = 0.0;  ///< way at its start
  Pose T_map_odom_ = Pose::Identity();
};

}  // namespace hv::loop
