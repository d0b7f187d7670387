#include "loop_engine.h"

#include <algorithm>
#include <utility>

namespace hv::loop {
namespace {

SessionStart Begin(const std::string& continue_map, KeyframeStore& store, LoopCloser& closer) {
  return continue_map.empty() ? SessionStart() : ContinueMap(continue_map, store, closer);
}

}  // namespace

LoopEngine::LoopEngine(const LoopConfig& config, const std::string& work_folder,
                       const std::string& continue_map)
    : store_(work_folder, config.store, Eigen::Vector3d::Zero()),
      closer_(config, store_),
      numbering_(Begin(continue_map, store_, closer_)) {
  state_.keyframes = state_.continued = closer_.graph().size();
  state_.joined = closer_.Joined();
}

void LoopEngine::Add(DecodedKeyframe decoded) {
  if (!decoded.error.empty()) {
    Refuse("keyframe " + std::to_string(decoded.keyframe.id) + " is unusable: " + decoded.error);
    return;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  try {
    Take(decoded);
  } catch (const InputError& error) {
    Refuse(error.what());
  }
}

void LoopEngine::Take(DecodedKeyframe& decoded) {
  Keyframe& keyframe = decoded.keyframe;
  const KeyframeNumbering::Verdict verdict = numbering_.Renumber(keyframe);
  if (verdict == KeyframeNumbering::Verdict::kRepeated) {
    Refuse("keyframe " + std::to_string(keyframe.id) + " comes a second time");
    return;
  }
  if (verdict == KeyframeNumbering::Verdict::kRestarted) closer_.StartSession();
  store_.SetLidarInImu(decoded.header.lidar_in_imu);
  Note(closer_.Add(keyframe));
}

void LoopEngine::Finish() {
  const std::lock_guard<std::mutex> lock(mutex_);
  try {
    Note(closer_.Finish());
  } catch (const InputError& error) {
    Refuse(error.what());
  }
}

void LoopEngine::Refuse(const std::string& reason) {
  const std::lock_guard<std::mutex> lock(state_mutex_);
  ++state_.revision;
  ++state_.unusable;
  state_.last_error = reason;
}

void LoopEngine::Note(const LoopUpdate& update) {
  const auto& candidates = closer_.candidates();
  const std::lock_guard<std::mutex> lock(state_mutex_);
  ++state_.revision;
  state_.keyframes = closer_.graph().size();
  state_.missing = numbering_.missing();
  state_.candidates = candidates.size();
  state_.loops = static_cast<std::size_t>(std::count_if(
      candidates.begin(), candidates.end(), [](const auto& loop) { return loop.accepted; }));
  state_.joined = closer_.Joined();
  state_.T_map_odom = closer_.T_map_odom();
  const LoopDetector::Timing& detection = update.detection;
  if (detection.extract_ms > 0.0) {
    state_.detection_ms = detection.extract_ms + detection.query_ms + detection.align_ms;
  }
  if (!update.optimized) return;
  ++state_.optimized;
  state_.optimization_ms = 1e3 * update.graph.seconds;
  state_.optimization = update.graph.reason;
}

LoopState LoopEngine::state() const {
  const std::lock_guard<std::mutex> lock(state_mutex_);
  return state_;
}

MapSnapshot LoopEngine::Snapshot() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return SnapshotOf(closer_);
}

LoopView LoopEngine::View() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return {closer_.PlacedVertices(), closer_.graph().edges(), closer_.candidates()};
}

}  // namespace hv::loop
