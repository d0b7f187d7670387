#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hv_core/config.h"
#include "hv_explore_sac/exploration_map.h"
#include "hv_explore_sac/exploration_model.h"
#include "hv_explore_sac/observation.h"
#include "hv_explore_sac/ray_sensor.h"

namespace hv::explore {

/// Settings of the planners that need no learning. Lengths are in cells of the belief.
struct PlannerConfig {
  double utility_decay = 0.02;  ///< of the utility with the distance [1/cells]
  double branch_decay = 0.03;   ///< the same along a branch [1/cells]
  double keep_goal = 1.1;       ///< another goal must be so many times better
  int tour_samples = 20;        ///< set covers that are tried for each tour
  int oracle_trials = 4;        ///< changes of its route that the oracle tries at each decision

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// A decision, as nodes of the observation.
struct Decision {
  int action = Observation::kRobot;  ///< where to drive next: an action of the observation
  int goal = Observation::kRobot;    ///< where that leads in the end
};

/// Chooses where to drive. Made for one run. Not thread-safe.
class Planner {
 public:
  virtual ~Planner() = default;

  /// `observation` was made from `model` and offers at least one action; some node has utility.
  virtual Decision Choose(const Observation& observation, const ExplorationModel& model) = 0;

  /// Nothing is left to explore. No other call follows.
  virtual void End(const ExplorationModel& model) { static_cast<void>(model); }
};

/// What a planner may be made from. The map is for the oracle alone.
struct PlannerInputs {
  PlannerConfig planner;
  ExplorationConfig exploration;
  const RaySensor* sensor = nullptr;
  const ExplorationMap* map = nullptr;
};

/// nearest, utility, ratio, tour, branch, oracle: those that need no learning.
const std::vector<std::string>& PlannerNames();
/// The name of the learned one, which is made from its weights (policy/planner_maker.h).
inline constexpr const char* kLearnedPlanner = "sac";

/// Throws InputError that names the known planners for an unknown one.
std::unique_ptr<Planner> MakePlanner(const std::string& name, const PlannerInputs& inputs);

}  // namespace hv::explore
