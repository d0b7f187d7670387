#include "hv_explore_sac/exploration_model.h"

namespace hv::explore {

ExplorationModel::ExplorationModel(const ExplorationConfig& config, int width, int height)
    : config_(config),
      belief_(width, height),
      frontiers_(config.frontier, belief_),
      graph_(config.viewpoint, belief_),
      views_(config.viewpoint) {}

void ExplorationModel::Update(const Eigen::Vector2i& cell) {
  frontiers_.Update(belief_);
  graph_.Update(belief_);
  robot_ = graph_.Add(cell, belief_);
  graph_.MarkVisited(robot_);
  views_.Update(belief_, frontiers_, graph_);
  belief_.ClearChanges();
  ways_.Run(graph_, robot_);
  Remember(cell);
}

int ExplorationModel::UtilityOf(int viewpoint) const {
  const int seen = views_.CountSeen(viewpoint);
  return graph_.Visited(viewpoint) || seen < config_.viewpoint.min_utility ? 0 : seen;
}

void ExplorationModel::Observe(Observation& observation) const {
  const std::vector<int>& order = ways_.order();
  const Eigen::Vector2i& origin = graph_.CellOf(robot_);
  node_of_.assign(static_cast<std::size_t>(graph_.size()), -1);
  const auto node_of = [this](int viewpoint) -> int& {
    return node_of_[static_cast<std::size_t>(viewpoint)];
  };
  observation.nodes.clear();
  for (const int viewpoint : order) {
    node_of(viewpoint) = observation.size();
    const int before = ways_.Predecessor(viewpoint);
    observation.nodes.push_back({(graph_.CellOf(viewpoint) - origin).cast<float>(),
                                 graph_.Visited(viewpoint), UtilityOf(viewpoint),
                                 ways_.DistanceTo(viewpoint), before < 0 ? -1 : node_of(before),
                                 viewpoint});
  }
  observation.edges.clear();
  observation.first_edge.assign(1, 0);
  for (const int viewpoint : order) {
    for (const ViewpointGraph::Edge& edge : graph_.EdgesOf(viewpoint)) {
      observation.edges.push_back({node_of(edge.to), edge.length});
    }
    observation.first_edge.push_back(static_cast<int>(observation.edges.size()));
  }
  observation.history.clear();
  for (const Eigen::Vector2i& cell : history_) {
    const int viewpoint = graph_.At(cell);
    if (viewpoint >= 0 && node_of(viewpoint) >= 0) {
      observation.history.push_back(node_of(viewpoint));
    }
  }
  observation.explored = belief_.free_count();
}

void ExplorationModel::Remember(const Eigen::Vector2i& cell) {
  if (!history_.empty() && history_.back() == cell) return;
  if (history_.size() == Observation::kHistory) history_.pop_front();
  history_.push_back(cell);
}

}  // namespace hv::explore
