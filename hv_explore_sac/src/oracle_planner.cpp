#include "oracle_planner.h"

namespace hv::explore {
namespace {

/// How much harder the route of the first decision is looked for.
constexpr int kFirstFactor = 10;

}  // namespace

OraclePlanner::OraclePlanner(const PlannerInputs& inputs)
    : config_(inputs.planner),
      knowledge_(inputs.exploration, *inputs.sensor, *inputs.map),
      search_(knowledge_, inputs.exploration.simulation.unseen_allowed / MapKnowledge::kStride, 1) {
}

Decision OraclePlanner::Choose(const Observation& observation, const ExplorationModel& model) {
  const Eigen::Vector2i& cell = model.graph().CellOf(model.robot());
  const int here = knowledge_.graph().At(cell);
  const int trials = first_ ? kFirstFactor * config_.oracle_trials : config_.oracle_trials;
  first_ = false;
  while (!route_.empty() && route_.front() == here) route_.erase(route_.begin());
  route_ = search_.Plan(here, knowledge_.KnownIn(model.belief()), std::move(route_), trials);
  int goal = Observation::kRobot;
  if (!route_.empty()) goal = FarthestKnown(here, route_.front(), observation, model);
  if (goal == Observation::kRobot) goal = observation.NearestWithUtility();
  return {observation.FirstHopTo(goal), goal};
}

/// The last viewpoint on the way that the robot knows a way to.
int OraclePlanner::FarthestKnown(int from, int to, const Observation& observation,
                                 const ExplorationModel& model) const {
  node_of_.assign(static_cast<std::size_t>(model.graph().size()), -1);
  for (int i = 0; i < observation.size(); ++i) {
    node_of_[static_cast<std::size_t>(observation.node(i).viewpoint)] = i;
  }
  int farthest = Observation::kRobot;
  for (int at = from; at != to;) {
    at = knowledge_.NextHop(at, to);
    const int viewpoint = model.graph().At(knowledge_.graph().CellOf(at));
    if (viewpoint < 0 || node_of_[static_cast<std::size_t>(viewpoint)] < 0) break;
    farthest = node_of_[static_cast<std::size_t>(viewpoint)];
  }
  return farthest;
}

}  // namespace hv::explore
