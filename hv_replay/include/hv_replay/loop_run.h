#pragma once

#include <string>
#include <vector>

#include "hv_core/keyframe_store.h"
#include "hv_core/trajectory.h"
#include "hv_lio/keyframe_selector.h"
#include "hv_loop_btc/loop_closer.h"
#include "hv_replay/slam_config.h"

namespace hv::replay {

/// What loop closing did in a run.
struct LoopRunSummary {
  std::size_t keyframes = 0;
  std::size_t candidates = 0;
  std::size_t loops = 0;
  std::vector<double> detect_ms;    ///< extraction and query of each submap
  std::vector<double> align_ms;     ///< fine alignments of each submap
  std::vector<double> optimize_ms;  ///< each optimisation
};

/// Loop closing over the scans of an offline run: the second half of `hv_slam`, with the core that
/// the loop closing node uses.
class LoopRun {
 public:
  /// Works in `out_dir`, which exists.
  LoopRun(const SlamConfig& config, const std::string& out_dir);

  void Add(const lio::ScanResult& result);

  /// Ends the run: writes trajectory.tum (`odometry` carried to the corrected map), loops.csv and
  /// map/. Throws InputError.
  LoopRunSummary Finish(const std::vector<StampedPose>& odometry);

 private:
  void Note(const loop::LoopUpdate& update);
  void WriteLoops() const;
  void WriteMap() const;

  SlamConfig config_;
  std::string out_dir_;
  lio::KeyframeSelector keyframes_;
  KeyframeStore store_;
  loop::LoopCloser closer_;
  LoopRunSummary summary_;
};

}  // namespace hv::replay
