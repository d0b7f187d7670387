#include "hv_explore_sac/loop_guard.h"

#include <algorithm>

namespace hv::explore {
namespace {

int NodeAt(const Eigen::Vector2i& cell, const Observation& observation,
           const ExplorationModel& model) {
  for (int i = 0; i < observation.size(); ++i) {
    if (model.graph().CellOf(observation.node(i).viewpoint) == cell) return i;
  }
  return Observation::kRobot;
}

}  // namespace

void GuardConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("enabled", enabled, "whether loops are broken off");
  visitor.Field("revisits", revisits, "of a viewpoint without anything new that make a loop");
  visitor.Field("new_cells", new_cells, "free cells that count as something new");
  visitor.Field("refused_radius", refused_radius,
                "viewpoints so near to a goal that failed are left alone too [cells]");
  visitor.Field("refused_for", refused_for, "decisions for which they are left alone");
}

void GuardConfig::Validate(ConfigProblems& problems) const {
  problems.Require(revisits >= 1, "guard.revisits", "must be at least 1");
  problems.Require(new_cells >= 1, "guard.new_cells", "must be at least 1");
  problems.Require(refused_radius >= 0.0, "guard.refused_radius", "must not be negative");
  problems.Require(refused_for >= 1, "guard.refused_for", "must be at least 1");
}

Decision LoopGuard::Review(const Decision& decision, const Observation& observation,
                           const ExplorationModel& model) {
  if (!config_.enabled) return decision;
  const bool in_loop = InLoop(observation, model);
  int goal = goal_ ? NodeAt(*goal_, observation, model) : Observation::kRobot;
  if (observation.node(goal).utility == 0) goal_.reset();
  if (!goal_ && in_loop) {
    ++interventions_;
    goal = observation.NearestWithUtility();
    goal_ = model.graph().CellOf(observation.node(goal).viewpoint);
  }
  if (!goal_) return decision;
  return {observation.FirstHopTo(goal), goal};
}

bool LoopGuard::InLoop(const Observation& observation, const ExplorationModel& model) {
  if (observation.explored >= explored_ + config_.new_cells) {
    explored_ = observation.explored;
    seen_.clear();
  }
  const Eigen::Vector2i& cell = model.graph().CellOf(model.robot());
  return ++seen_[{cell.x(), cell.y()}] > config_.revisits;
}

int RefusedGoals::Apply(Observation& observation, const ExplorationModel& model) {
  ++now_;
  refused_.erase(std::remove_if(refused_.begin(), refused_.end(),
                                [this](const Entry& entry) {
                                  return now_ - entry.since > config_.refused_for;
                                }),
                 refused_.end());
  int count = 0;
  for (Observation::Node& node : observation.nodes) {
    const Eigen::Vector2i& cell = model.graph().CellOf(node.viewpoint);
    const bool refused = std::any_of(refused_.begin(), refused_.end(), [&](const Entry& entry) {
      return (entry.cell - cell).cast<double>().norm() <= config_.refused_radius;
    });
    count += refused && node.utility > 0;
    if (refused) node.utility = 0;
  }
  return count;
}

}  // namespace hv::explore
