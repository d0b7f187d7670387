#include "hv_explore_sac/exploration_task.h"

#include <cmath>

namespace hv::explore {

std::string ProblemOf(const ExplorationTask& task) {
  const bool budget_valid = std::isfinite(task.time_budget_s) && task.time_budget_s >= 0.0;
  if (!budget_valid) return "the time budget is not a number of seconds";
  return task.bounds.Problem();
}

const char* ToString(ExplorationEnd end) {
  switch (end) {
    case ExplorationEnd::kExplored:
      return "explored: no frontiers are left";
    case ExplorationEnd::kUnreachable:
      return "nothing is left that can be reached";
    case ExplorationEnd::kOutOfTime:
      return "out of time";
    case ExplorationEnd::kCancelled:
      return "cancelled";
    case ExplorationEnd::kNavigationFails:
      return "navigation fails";
    case ExplorationEnd::kNoFreePlace:
      return "the robot does not stand on free ground inside of the bounds";
    case ExplorationEnd::kInputsLost:
      return "inputs lost";
  }
  return "";
}

bool Completes(ExplorationEnd end) {
  return end == ExplorationEnd::kExplored || end == ExplorationEnd::kUnreachable;
}

bool AllowsReturn(ExplorationEnd end) {
  return Completes(end) || end == ExplorationEnd::kOutOfTime ||
         end == ExplorationEnd::kNavigationFails;
}

}  // namespace hv::explore
