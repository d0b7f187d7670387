#pragma once

#include <algorithm>
#include <string>

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include "hv_explore_sac/explorer.h"

namespace hv::explore {

/// What the diagnostics tell of the exploration. For one thread.
class ExplorationHealth {
 public:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  void Note(const ExplorerOutput& output, const ExplorationProgress& progress);
  void NoteMap(const std::string& problem, double cells);
  void NoteCycle(double cycle_ms) { longest_cycle_ms_ = std::max(longest_cycle_ms_, cycle_ms); }

  void Describe(Status& status);

 private:
  ExplorerOutput output_;
  ExplorationProgress progress_;
  std::string last_result_;
  bool last_failed_ = false;
  std::size_t maps_ = 0;
  std::size_t maps_unusable_ = 0;
  std::size_t reported_unusable_ = 0;
  std::string map_problem_;
  double map_cells_ = 0.0;
  double longest_cycle_ms_ = 0.0;
};

}  // namespace hv::explore
