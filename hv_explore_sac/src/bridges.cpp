#include "bridges.h"

#include <algorithm>
#include <vector>

#include "hv_explore_sac/graph_search.h"

namespace hv::explore {
namespace {

/// Shortest ways from one cell over free ones, by steps to the four neighbours.
class CellFlood {
 public:
  CellFlood(const Belief& ground, const Eigen::Vector2i& start)
      : ground_(ground), parent_(static_cast<std::size_t>(ground.width() * ground.height()), -1) {
    const int first = ground.IndexOf(start);
    Parent(first) = first;
    order_.push_back(first);
    for (std::size_t i = 0; i < order_.size(); ++i) Spread(order_[i]);
  }

  /// All cells that are reached, by growing distance.
  const std::vector<int>& order() const { return order_; }

  /// The cell before on the way; the start comes before itself.
  Eigen::Vector2i Before(const Eigen::Vector2i& cell) const {
    return ground_.CellOf(parent_[static_cast<std::size_t>(ground_.IndexOf(cell))]);
  }

 private:
  int& Parent(int index) { return parent_[static_cast<std::size_t>(index)]; }

  void Spread(int index) {
    const Eigen::Vector2i cell = ground_.CellOf(index);
    for (const Eigen::Vector2i& step : {Eigen::Vector2i(1, 0), Eigen::Vector2i(-1, 0),
                                        Eigen::Vector2i(0, 1), Eigen::Vector2i(0, -1)}) {
      const Eigen::Vector2i next = cell + step;
      if (!ground_.Contains(next) || ground_.At(next) != Cell::kFree) continue;
      const int at = ground_.IndexOf(next);
      if (Parent(at) >= 0) continue;
      Parent(at) = index;
      order_.push_back(at);
    }
  }

  const Belief& ground_;
  std::vector<int> parent_;
  std::vector<int> order_;
};

/// Follows the way back to the start as far as the straight line to `from` is free and short.
Eigen::Vector2i FarthestSeen(const CellFlood& flood, const Belief& ground,
                             const Eigen::Vector2i& from, double spacing) {
  Eigen::Vector2i seen = flood.Before(from);
  while (true) {
    const Eigen::Vector2i next = flood.Before(seen);
    const bool far = (next - from).cast<double>().norm() > spacing;
    if (next == seen || far || ground.FirstBlocked(next, from) != Belief::kNone ||
        ground.FirstBlocked(from, next) != Belief::kNone) {
      return seen;
    }
    seen = next;
  }
}

bool Touches(const ViewpointGraph& graph, const GraphSearch& search, int viewpoint, int known) {
  const auto& edges = graph.EdgesOf(viewpoint);
  return std::any_of(edges.begin(), edges.end(), [&](const ViewpointGraph::Edge& edge) {
    return edge.to < known && search.Reached(edge.to);
  });
}

}  // namespace

void BridgeGaps(ViewpointGraph& graph, const Belief& ground, int robot, double spacing) {
  const CellFlood flood(ground, graph.CellOf(robot));
  GraphSearch search;
  search.Run(graph, robot);
  for (const int index : flood.order()) {
    const int lone = graph.At(ground.CellOf(index));
    if (lone < 0 || search.Reached(lone)) continue;
    const int known = graph.size();
    for (int at = lone; at != robot && !Touches(graph, search, at, known);) {
      at = graph.Add(FarthestSeen(flood, ground, Eigen::Vector2i(graph.CellOf(at)), spacing),
                     ground);
    }
    search.Run(graph, robot);
  }
}

}  // namespace hv::explore
