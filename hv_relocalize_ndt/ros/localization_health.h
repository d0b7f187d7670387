#pragma once

#include <mutex>
#include <string>

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include "localization_engine.h"
#include "scan_queue.h"

namespace hv::relocalize {

/// Fills the diagnostics of the localisation node from its parts. Thread-safe.
class LocalizationHealth {
 public:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  /// Both must outlive this object.
  LocalizationHealth(const LocalizationEngine& engine, const ScanQueue& queue);

  /// One line that overrides the state while not empty (nobody publishes scans).
  void SetProblem(const std::string& problem);

  /// A message that could not be used, and why.
  void OnUnusable(const std::string& error);

  /// State, place, fit, times, counters.
  void DescribeLocalization(Status& status);
  /// The map and memory.
  void DescribeMap(Status& status);

 private:
  void Summarize(const LocalizationState& state, Status& status) const;

  const LocalizationEngine& engine_;
  const ScanQueue& queue_;
  mutable std::mutex mutex_;  // guards everything below
  std::string problem_;
  std::size_t unusable_ = 0;
  std::size_t reported_unusable_ = 0;
  std::string last_error_;
};

}  // namespace hv::relocalize
