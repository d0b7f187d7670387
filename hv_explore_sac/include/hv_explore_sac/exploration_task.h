#pragma once

#include <string>

#include "hv_explore_sac/bounds.h"

namespace hv::explore {

/// What is to be explored.
struct ExplorationTask {
  Bounds bounds;
  double time_budget_s = 0.0;  ///< without pauses; 0: as long as it takes
  bool return_home = false;    ///< to where it began, in the end
};

/// What is wrong with a task in one line; empty when nothing is.
std::string ProblemOf(const ExplorationTask& task);

/// How an exploration ends.
enum class ExplorationEnd {
  kExplored,     ///< no frontiers are left
  kUnreachable,  ///< none that can be reached
  kOutOfTime,
  kCancelled,
  kNavigationFails,  ///< too many goals in a row
  kNoFreePlace,      ///< the robot stands in an obstacle, or outside of the bounds
  kInputsLost        ///< no map, or no place in it
};

const char* ToString(ExplorationEnd end);

/// Whether all that can be reached has been explored.
bool Completes(ExplorationEnd end);
/// Whether the robot can still drive.
bool AllowsReturn(ExplorationEnd end);

/// How far an exploration has come.
struct ExplorationProgress {
  double explored_m2 = 0.0;  ///< known to be free, inside of the bounds
  int frontiers = 0;         ///< frontier points left
  double travelled_m = 0.0;
  double elapsed_s = 0.0;  ///< without pauses
  int decisions = 0;
  int goals = 0;  ///< sent
  int failed_goals = 0;
  int loops = 0;  ///< broken off
};

struct ExplorationResult {
  ExplorationEnd end = ExplorationEnd::kExplored;
  std::string reason;    ///< one line
  bool success = false;  ///< all that can be reached has been explored, and home was if asked for
  ExplorationProgress progress;
};

}  // namespace hv::explore
