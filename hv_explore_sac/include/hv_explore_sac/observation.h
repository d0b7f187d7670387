#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/Core>

namespace hv::explore {

/// What a planner decides from (Eq. 12-13 of the paper, with geodesic distances): the viewpoints
/// that the robot can reach, the edges among them and where the robot has been. Lengths are in
/// cells of the belief. Reused from decision to decision, so that it allocates no memory once
/// grown.
struct Observation {
  static constexpr std::size_t kHistory = 32;

  struct Node {
    Eigen::Vector2f position;  ///< relative to the robot
    bool visited;
    int utility;      ///< observable frontier points; 0 when visited or fewer than the threshold
    float distance;   ///< of the shortest way from the robot
    int predecessor;  ///< the node before on that way; -1 for the robot's own
    int viewpoint;    ///< its number in the graph
  };
  struct Edge {
    int to;
    float length;
  };

  std::vector<Node> nodes;      ///< by increasing distance, the robot's own first
  std::vector<int> first_edge;  ///< edges of node i: [first_edge[i], first_edge[i + 1])
  std::vector<Edge> edges;
  std::vector<int> history;  ///< nodes the robot stood at, oldest first, the present one last
  double explored = 0.0;     ///< known free cells

  static constexpr int kRobot = 0;
  int size() const { return static_cast<int>(nodes.size()); }
  const Node& node(int index) const { return nodes[static_cast<std::size_t>(index)]; }

  /// The nearest node from which frontiers are seen; the robot's own where there is none.
  int NearestWithUtility() const {
    const auto found =
        std::find_if(nodes.begin(), nodes.end(), [](const Node& node) { return node.utility > 0; });
    return found == nodes.end() ? kRobot : static_cast<int>(found - nodes.begin());
  }

  /// The edges of a node, by increasing length.
  struct EdgeRange {
    const Edge* begin_edge;
    const Edge* end_edge;
    const Edge* begin() const { return begin_edge; }
    const Edge* end() const { return end_edge; }
    std::size_t size() const { return static_cast<std::size_t>(end_edge - begin_edge); }
    const Edge& operator[](std::size_t index) const { return begin_edge[index]; }
  };
  EdgeRange EdgesOf(int index) const {
    const auto at = static_cast<std::size_t>(index);
    return {edges.data() + first_edge[at], edges.data() + first_edge[at + 1]};
  }
  /// The candidate actions: edges from the robot's node (paper, section 3.3.2).
  EdgeRange Actions() const { return EdgesOf(kRobot); }

  /// The first node after the robot's own on the shortest way to a node; the robot's own for
  /// itself.
  int FirstHopTo(int index) const;

  /// Whether any node observes frontier points (Eq. 14).
  bool AnyUtility() const;
};

}  // namespace hv::explore
