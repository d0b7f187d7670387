#include "hv_explore_sac/policy/policy_planner.h"

#include <utility>

namespace hv::explore {

PolicyPlanner::PolicyPlanner(std::shared_ptr<const PolicyNetwork> network)
    : network_(std::move(network)), builder_(network_->settings().policy) {}

Decision PolicyPlanner::Choose(const Observation& observation, const ExplorationModel& model) {
  builder_.Build(observation, model, goal_, input_);
  Eigen::VectorXf preference = network_->Choose(input_).log_probability;
  for (Eigen::Index i = 0; i < preference.size(); ++i) {
    if (input_.features(input_.actions[static_cast<std::size_t>(i)], PolicyInput::kIsKept) > 0.0F) {
      preference[i] += static_cast<float>(network_->settings().policy.keep_goal);
    }
  }
  Eigen::Index best = 0;
  preference.maxCoeff(&best);
  choice_ = static_cast<int>(best);
  const int node = builder_.goals()[static_cast<std::size_t>(best)].node;
  goal_ = model.graph().CellOf(observation.node(node).viewpoint);
  return {observation.FirstHopTo(node), node};
}

}  // namespace hv::explore
