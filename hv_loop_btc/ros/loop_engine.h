#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "hv_core/keyframe_store.h"
#include "hv_loop_btc/loop_closer.h"
#include "hv_loop_btc/map_saver.h"
#include "hv_ros/keyframe_message.h"
#include "keyframe_numbering.h"

namespace hv::loop {

/// What is worth knowing after each keyframe.
struct LoopState {
  std::uint64_t revision = 0;   ///< grows with everything that is taken in
  std::uint64_t optimized = 0;  ///< times that earlier keyframes were moved
  std::size_t keyframes = 0;    ///< of the map, with those of earlier sessions
  std::size_t continued = 0;    ///< of these, those of a continued map
  std::size_t missing = 0;      ///< numbered by the odometry, but never received
  std::size_t unusable = 0;     ///< received, but refused
  std::string last_error;       ///< why the last of them was refused
  std::size_t candidates = 0;
  std::size_t loops = 0;  ///< accepted
  double detection_ms = 0.0;
  double optimization_ms = 0.0;
  std::string optimization;  ///< what the last one did
  bool joined = true;        ///< the place in the map is known
  Pose T_map_odom = Pose::Identity();
};

/// What is drawn of a map.
struct LoopView {
  std::vector<GraphVertex> placed;
  std::vector<GraphEdge> edges;
  std::vector<LoopCandidate> candidates;
};

/// Store and LoopCloser behind one lock. Thread-safe: state() never waits for a keyframe that is
/// being processed; what needs the map waits for at most one.
class LoopEngine {
 public:
  /// Clouds of keyframes are kept in `work_folder`. `continue_map`: a saved map that the session
  /// continues, or empty. Throws InputError.
  LoopEngine(const LoopConfig& config, const std::string& work_folder,
             const std::string& continue_map);

  /// Takes a keyframe in: submaps, loops, optimisation. Bad ones are counted, and said why.
  void Add(DecodedKeyframe decoded);

  /// At the end of the data: see LoopCloser::Finish().
  void Finish();

  LoopState state() const;
  MapSnapshot Snapshot() const;
  LoopView View() const;
  const KeyframeStore& store() const { return store_; }

 private:
  void Take(DecodedKeyframe& decoded);
  void Refuse(const std::string& reason);
  void Note(const LoopUpdate& update);

  mutable std::mutex mutex_;  // guards closer_ and numbering_
  KeyframeStore store_;
  LoopCloser closer_;
  KeyframeNumbering numbering_;

  mutable std::mutex state_mutex_;  // guards state_; taken while holding mutex_, never before it
  LoopState state_;
};

}  // namespace hv::loop
