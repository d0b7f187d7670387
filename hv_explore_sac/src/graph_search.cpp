#include "hv_explore_sac/graph_search.h"

#include <algorithm>
#include <functional>

namespace hv::explore {

void GraphSearch::Run(const ViewpointGraph& graph, int start) {
  const auto size = static_cast<std::size_t>(graph.size());
  distance_.assign(size, kUnreached);
  predecessor_.assign(size, -1);
  order_.clear();
  open_.assign(1, {0.0F, start});
  distance_[static_cast<std::size_t>(start)] = 0.0F;
  while (!open_.empty()) {
    std::pop_heap(open_.begin(), open_.end(), std::greater<>());
    const auto [distance, viewpoint] = open_.back();
    open_.pop_back();
    if (distance > DistanceTo(viewpoint)) continue;
    order_.push_back(viewpoint);
    for (const ViewpointGraph::Edge& edge : graph.EdgesOf(viewpoint)) {
      const auto to = static_cast<std::size_t>(edge.to);
      if (distance + edge.length >= distance_[to]) continue;
      distance_[to] = distance + edge.length;
      predecessor_[to] = viewpoint;
      open_.emplace_back(distance_[to], edge.to);
      std::push_heap(open_.begin(), open_.end(), std::greater<>());
    }
  }
}

std::vector<int> GraphSearch::WayTo(int viewpoint) const {
  std::vector<int> way;
  for (int at = viewpoint; at >= 0; at = Predecessor(at)) way.push_back(at);
  std::reverse(way.begin(), way.end());
  return way;
}

}  // namespace hv::explore
