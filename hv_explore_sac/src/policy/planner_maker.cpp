#include "hv_explore_sac/policy/planner_maker.h"

#include "hv_explore_sac/policy/policy_planner.h"

namespace hv::explore {

std::function<std::unique_ptr<Planner>(const PlannerInputs&)> PlannerMakerOf(
    const std::string& name, const std::string& weights) {
  if (name != kLearnedPlanner) {
    return [name](const PlannerInputs& inputs) { return MakePlanner(name, inputs); };
  }
  return [network = PolicyNetwork::Read(weights)](const PlannerInputs&) {
    return std::make_unique<PolicyPlanner>(network);
  };
}

}  // namespace hv::explore
