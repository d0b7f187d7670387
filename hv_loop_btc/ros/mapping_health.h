#pragma once

#include <cstdint>
#include <mutex>
#include <string>

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include "keyframe_queue.h"
#include "loop_engine.h"
#include "map_saving.h"

namespace hv::loop {

/// Fills the diagnostics of the loop closing node from its parts. Thread-safe.
class MappingHealth {
 public:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  /// All must outlive this object.
  MappingHealth(const LoopEngine& engine, const KeyframeQueue& queue, const MapSaving& saving,
                std::string work_folder);

  /// One line that overrides the state while not empty (nobody publishes keyframes).
  void SetProblem(const std::string& problem);

  /// Keyframes, queue, candidates, loops, times, place in the map.
  void DescribeLoops(Status& status);
  /// Memory, store on disk, last save.
  void DescribeMap(Status& status);

 private:
  void Summarize(const LoopState& state, const KeyframeQueue::Counters& queue,
                 Status& status) const;

  const LoopEngine& engine_;
  const KeyframeQueue& queue_;
  const MapSaving& saving_;
  const std::string work_folder_;
  mutable std::mutex mutex_;  // guards everything below
  std::string problem_;
  std::size_t reported_faults_ = 0;
};

}  // namespace hv::loop
