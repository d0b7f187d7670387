#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hv_explore_sac/dungeon_environment.h"
#include "hv_explore_sac/loop_guard.h"
#include "hv_explore_sac/planner.h"

namespace hv::explore {

/// Makes planners by their name. Called from several threads.
using PlannerFactory =
    std::function<std::unique_ptr<Planner>(const std::string& name, const PlannerInputs& inputs)>;

/// How planners are compared.
struct EvaluationConfig {
  ExplorationConfig exploration;
  PlannerConfig planner;
  GuardConfig guard;
  PlannerFactory make_planner = MakePlanner;
  int threads = 1;
};

/// One map explored by one planner.
struct RunResult {
  std::string map;
  std::string planner;
  std::string unit;
  double travel = 0.0;    ///< [unit]
  double explored = 0.0;  ///< share of the free cells, 0 to 1
  int steps = 0;
  Ending ending = Ending::kRunning;
  bool done = false;
  int interventions = 0;              ///< of the loop guard
  double decision_ms = 0.0;           ///< mean processor time of a decision, observation included
  double step_ms = 0.0;               ///< the same of a step of the environment
  std::vector<Eigen::Vector2i> path;  ///< cells
};

RunResult RunExploration(const ExplorationMap& map, const std::string& planner,
                         const RaySensor& sensor, const EvaluationConfig& config);

/// Every map with every planner, maps first, in parallel; the result does not depend on the number
/// of threads, times apart. `progress(done, total)` is called from one thread at a time. Throws
/// what a run throws.
std::vector<RunResult> Evaluate(const std::vector<ExplorationMap>& maps,
                                const std::vector<std::string>& planners,
                                const EvaluationConfig& config,
                                const std::function<void(std::size_t, std::size_t)>& progress);

/// Writes a picture of the map and the way driven (PNG). Throws InputError.
void DrawRun(const ExplorationMap& map, const RunResult& run, const std::string& path);

/// Writes the way driven, a point a line, as `x y` in the unit of the map. Throws InputError.
void WritePath(const ExplorationMap& map, const RunResult& run, const std::string& path);

}  // namespace hv::explore
