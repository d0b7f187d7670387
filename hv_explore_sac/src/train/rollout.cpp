#include "hv_explore_sac/train/rollout.h"

namespace hv::explore {

double Rollout::TravelVia(const DungeonEnvironment& environment,
                          const Eigen::Vector2i& goal) const {
  DungeonEnvironment copy(environment);
  while (copy.ending() == Ending::kRunning && StepTowards(copy, goal)) {
  }
  Finish(copy);
  return copy.travel() - environment.travel();
}

void Rollout::Finish(DungeonEnvironment& environment) const {
  const std::unique_ptr<Planner> planner = make_planner_(environment.map());
  LoopGuard guard(guard_);
  Observation observation;
  while (environment.ending() == Ending::kRunning) {
    environment.Observe(observation);
    const Decision decision = guard.Review(planner->Choose(observation, environment.model()),
                                           observation, environment.model());
    environment.Step(observation.node(decision.action).viewpoint);
  }
}

bool StepTowards(DungeonEnvironment& environment, const Eigen::Vector2i& goal) {
  const ExplorationModel& model = environment.model();
  const int viewpoint = model.graph().At(goal);
  if (viewpoint < 0 || model.UtilityOf(viewpoint) == 0 || !model.ways().Reached(viewpoint)) {
    return false;
  }
  int hop = viewpoint;
  while (model.ways().Predecessor(hop) != model.robot()) hop = model.ways().Predecessor(hop);
  environment.Step(hop);
  return true;
}

}  // namespace hv::explore
