#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "hv_explore_sac/viewpoint_graph.h"

namespace hv::explore {

/// Shortest ways along the edges of a graph from one viewpoint (Dijkstra). Keeps its memory between
/// runs. Not thread-safe.
class GraphSearch {
 public:
  static constexpr float kUnreached = std::numeric_limits<float>::infinity();

  void Run(const ViewpointGraph& graph, int start);
  /// Ends when all targets are reached; what is farther away may then not be, or not on the
  /// shortest way.
  void RunTo(const ViewpointGraph& graph, int start, const std::vector<int>& targets);

  /// Length of the way to a viewpoint [cells], kUnreached if there is none.
  float DistanceTo(int viewpoint) const { return distance_[static_cast<std::size_t>(viewpoint)]; }
  bool Reached(int viewpoint) const { return DistanceTo(viewpoint) < kUnreached; }

  /// The viewpoint before this one on the way; -1 for the start and what was not reached.
  int Predecessor(int viewpoint) const { return predecessor_[static_cast<std::size_t>(viewpoint)]; }

  /// Those that were reached, by increasing distance, the start first.
  const std::vector<int>& order() const { return order_; }

  /// From the start to a viewpoint that was reached.
  std::vector<int> WayTo(int viewpoint) const;

 private:
  template <typename Last>
  void Run(const ViewpointGraph& graph, int start, Last is_last);

  std::vector<float> distance_;
  std::vector<int> predecessor_;
  std::vector<int> order_;
  std::vector<std::uint64_t> open_;  ///< a heap of distances with viewpoints
};

}  // namespace hv::explore
