#include "exploration_health.h"

namespace hv::explore {
namespace {

using diagnostic_msgs::DiagnosticStatus;

}  // namespace

void ExplorationHealth::Note(const ExplorerOutput& output, const ExplorationProgress& progress) {
  output_ = output;
  progress_ = progress;
  if (!output.result) return;
  last_result_ = output.result->reason;
  last_failed_ = !output.result->success && output.result->end != ExplorationEnd::kCancelled;
}

void ExplorationHealth::NoteMap(const std::string& problem, double cells) {
  ++maps_;
  map_cells_ = cells;
  if (problem.empty()) return;
  ++maps_unusable_;
  map_problem_ = problem;
}

void ExplorationHealth::Describe(Status& status) {
  const std::string state = ToString(output_.state);
  const std::string text = output_.reason.empty() ? state : state + ": " + output_.reason;
  if (maps_unusable_ > reported_unusable_) {
    status.summary(DiagnosticStatus::WARN, map_problem_);
  } else if (output_.state == ExplorerState::kWaiting) {
    status.summary(DiagnosticStatus::WARN, text);
  } else if (output_.state == ExplorerState::kIdle && last_failed_) {
    status.summary(DiagnosticStatus::WARN, last_result_);
  } else {
    status.summary(DiagnosticStatus::OK, text);
  }
  reported_unusable_ = maps_unusable_;
  status.add("state", state);
  status.add("reason", output_.reason);
  status.addf("explored [m^2]", "%.1f", progress_.explored_m2);
  status.add("frontier points left", progress_.frontiers);
  status.addf("travelled [m]", "%.1f", progress_.travelled_m);
  status.addf("elapsed [s]", "%.1f", progress_.elapsed_s);
  status.add("goals", progress_.goals);
  status.add("goals failed", progress_.failed_goals);
  status.add("loops broken off", progress_.loops);
  status.add("last result", last_result_);
  status.add("maps", maps_);
  status.add("maps unusable", maps_unusable_);
  status.addf("cells of the map", "%.0f", map_cells_);
  status.addf("longest decision [ms]", "%.1f", longest_cycle_ms_);
}

}  // namespace hv::explore
