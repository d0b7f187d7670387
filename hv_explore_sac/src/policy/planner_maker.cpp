#include "hv_explore_sac/policy/planner_maker.h"

#include <utility>

#include "hv_explore_sac/online/learning_planner.h"
#include "hv_explore_sac/policy/policy_planner.h"

namespace hv::explore {

std::function<std::unique_ptr<Planner>(const PlannerInputs&)> PlannerMakerOf(
    const std::string& name, const std::string& weights, std::shared_ptr<OnlineLearner> learner) {
  if (name != kLearnedPlanner) {
    return [name](const PlannerInputs& inputs) { return MakePlanner(name, inputs); };
  }
  return [network = PolicyNetwork::Read(weights),
          learner = std::move(learner)](const PlannerInputs&) -> std::unique_ptr<Planner> {
    if (learner) return std::make_unique<LearningPlanner>(network, learner);
    return std::make_unique<PolicyPlanner>(network);
  };
}

}  // namespace hv::explore
