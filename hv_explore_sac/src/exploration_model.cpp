#include "hv_explore_sac/exploration_model.h"

#include <algorithm>

#include "bridges.h"

namespace hv::explore {

ExplorationModel::ExplorationModel(const ExplorationConfig& config, int width, int height,
                                   const Eigen::Vector2i& low)
    : config_(config),
      belief_(width, height, low),
      frontiers_(config.frontier, belief_),
      graph_(config.viewpoint, belief_),
      views_(config.viewpoint) {}

void ExplorationModel::Update(const Eigen::Vector2i& cell) {
  TakeChanges();
  robot_ = graph_.Add(cell, ground());
  graph_.MarkVisited(robot_);
  if (ground_) BridgeGaps(graph_, *ground_, robot_, config_.viewpoint.spacing_x);
  views_.Update(belief_, frontiers_, graph_);
  ways_.Run(graph_, robot_);
  Remember(cell);
}

void ExplorationModel::TakeChanges() {
  frontiers_.Update(belief_);
  graph_.Update(ground());
  belief_.ClearChanges();
  if (ground_) ground_->ClearChanges();
}

void ExplorationModel::Recall(const std::vector<Eigen::Vector2i>& stood, double radius) {
  TakeChanges();
  for (const Eigen::Vector2i& cell : stood) {
    if (!ground().Contains(cell) || ground().At(cell) != Cell::kFree) continue;
    graph_.Add(cell, ground());
    Remember(cell);
  }
  for (int viewpoint = 0; viewpoint < graph_.size(); ++viewpoint) {
    const Eigen::Vector2i& at = graph_.CellOf(viewpoint);
    const bool visited = std::any_of(stood.begin(), stood.end(), [&](const Eigen::Vector2i& cell) {
      return (cell - at).cast<double>().norm() <= radius;
    });
    if (visited) graph_.MarkVisited(viewpoint);
  }
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
