#include "hv_explore_sac/policy/goals.h"

#include <algorithm>
#include <cmath>

namespace hv::explore {

const std::vector<Goal>& GoalSelector::Select(const Observation& observation,
                                              const ExplorationModel& model) {
  Rank(observation, PolicyScale(model.config()));
  goals_.clear();
  covered_.clear();
  for (const Ranked& ranked : ranked_) {
    if (goals_.size() == static_cast<std::size_t>(config_.most_goals)) break;
    Goal goal{ranked.node, 0, ranked.rank, Eigen::Vector2f::Zero()};
    if (TakeFresh(observation, model, goal)) goals_.push_back(goal);
  }
  return goals_;
}

void GoalSelector::Rank(const Observation& observation, const PolicyScale& scale) {
  ranked_.clear();
  const float decay = static_cast<float>(config_.goal_decay) / scale.unit;
  for (int i = 0; i < observation.size(); ++i) {
    const Observation::Node& node = observation.node(i);
    if (node.utility == 0) continue;
    const float points = scale.point * static_cast<float>(node.utility);
    ranked_.push_back({std::log(points) - decay * node.distance, i});
  }
  std::stable_sort(ranked_.begin(), ranked_.end(),
                   [](const Ranked& a, const Ranked& b) { return a.rank > b.rank; });
}

bool GoalSelector::TakeFresh(const Observation& observation, const ExplorationModel& model,
                             Goal& goal) {
  const int viewpoint = observation.node(goal.node).viewpoint;
  model.views().ListSeen(viewpoint, seen_);
  fresh_.clear();
  for (const int point : seen_) {
    const auto at = static_cast<std::size_t>(point);
    if (at >= covered_.size()) covered_.resize(at + 1, 0);
    if (covered_[at] == 0) fresh_.push_back(point);
  }
  const double share = static_cast<double>(fresh_.size()) / static_cast<double>(seen_.size());
  if (fresh_.empty() || share < config_.fresh_share) return false;
  Eigen::Vector2f sum = Eigen::Vector2f::Zero();
  for (const int point : fresh_) {
    covered_[static_cast<std::size_t>(point)] = 1;
    sum += model.frontiers().CellOf(point).cast<float>();
  }
  goal.fresh = static_cast<int>(fresh_.size());
  goal.frontier =
      sum / static_cast<float>(fresh_.size()) - model.graph().CellOf(model.robot()).cast<float>();
  return true;
}

}  // namespace hv::explore
