#include "branch_planner.h"

#include <cmath>

namespace hv::explore {

Decision BranchPlanner::Choose(const Observation& observation, const ExplorationModel& model) {
  gain_.assign(observation.nodes.size(), 0.0);
  int best = Observation::kRobot;
  double best_gain = 0.0;
  for (int i = 1; i < observation.size(); ++i) {
    const Observation::Node& node = observation.node(i);
    double& gain = gain_[static_cast<std::size_t>(i)];
    gain = gain_[static_cast<std::size_t>(node.predecessor)] +
           node.utility * std::exp(-config_.branch_decay * static_cast<double>(node.distance));
    if (node.utility == 0) continue;
    const bool kept = model.graph().CellOf(node.viewpoint) == goal_;
    const double weighed = kept ? config_.keep_goal * gain : gain;
    if (weighed <= best_gain) continue;
    best = i;
    best_gain = weighed;
  }
  goal_ = model.graph().CellOf(observation.node(best).viewpoint);
  return {observation.FirstHopTo(best), best};
}

}  // namespace hv::explore
