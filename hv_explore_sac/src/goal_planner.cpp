#include "goal_planner.h"

namespace hv::explore {

Decision GoalPlanner::Choose(const Observation& observation, const ExplorationModel& model) {
  int best = Observation::kRobot;
  double best_score = 0.0;
  for (int i = 0; i < observation.size(); ++i) {
    const Observation::Node& node = observation.node(i);
    if (node.utility == 0) continue;
    double score = score_(node);
    if (model.graph().CellOf(node.viewpoint) == goal_) score *= keep_goal_;
    if (score <= best_score) continue;
    best = i;
    best_score = score;
  }
  goal_ = model.graph().CellOf(observation.node(best).viewpoint);
  return {observation.FirstHopTo(best), best};
}

}  // namespace hv::explore
