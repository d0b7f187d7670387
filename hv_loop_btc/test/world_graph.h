#pragma once

#include <algorithm>
#include <vector>

#include "graph_world.h"
#include "hv_loop_btc/pose_graph.h"

namespace hv::loop {

/// The graph of a world with `loops`, keyframes at 10 Hz. No odometry edge leads to the keyframes
/// in `starts`: each begins a segment with a frame of its own.
inline PoseGraph BuildGraph(const GraphWorld& world, const std::vector<GraphEdge>& loops,
                            const PoseGraphConfig& config = PoseGraphConfig(),
                            const std::vector<std::uint32_t>& starts = {}) {
  PoseGraph graph(config);
  Pose guess = world.truth().front();
  graph.AddVertex(0, Time(), guess);
  for (const GraphEdge& edge : world.odometry()) {
    const bool starts_segment = std::count(starts.begin(), starts.end(), edge.to) != 0;
    guess = starts_segment ? Pose::Identity() : guess * edge.T_from_to;
    graph.AddVertex(edge.to, Time() + 0.1 * edge.to, guess);
    if (!starts_segment) graph.AddEdge(edge);
  }
  for (const GraphEdge& loop : loops) graph.AddEdge(loop);
  return graph;
}

/// Numbers of accepted loops among the first `true_loops` of the graph and among the others.
struct AcceptedLoops {
  std::size_t good = 0;
  std::size_t bad = 0;
};

inline AcceptedLoops CountAccepted(const PoseGraph& graph, std::size_t true_loops) {
  AcceptedLoops accepted;
  std::size_t seen = 0;
  for (const GraphEdge& edge : graph.edges()) {
    if (edge.kind != EdgeKind::kLoop) continue;
    const bool good = seen++ < true_loops;
    if (edge.accepted) ++(good ? accepted.good : accepted.bad);
  }
  return accepted;
}

inline void Append(const std::vector<GraphEdge>& more, std::vector<GraphEdge>& loops) {
  loops.insert(loops.end(), more.begin(), more.end());
}

}  // namespace hv::loop
