#pragma once

#include <cstdint>
#include <vector>

#include "hv_explore_sac/nn/tensor.h"

namespace hv::explore::nn {

/// What a caller knows of one decision: the viewpoint graph (paper, section 3.3.1) in numbers of
/// size about one.
struct GraphInput {
  /// [nodes x features]
  Matrix<float> features;
  /// [nodes x 2], in a unit in which neighbours are about one apart.
  Matrix<float> positions;
  /// Neighbours of node i are neighbour[start[i] .. start[i + 1]); a node need not name itself.
  std::vector<std::int32_t> start = {0};
  std::vector<std::int32_t> neighbour;
  /// The node where the robot is, and those it may go to next.
  std::int32_t current = 0;
  std::vector<std::int32_t> actions;
  /// Features of the nodes visited last, oldest first: [0 .. window x features].
  Matrix<float> history;
  /// Numbers of the whole state; more for a critic that may see the true map.
  Eigen::VectorXf globals;
};

/// One scale of the graph with its lists, each beginning with the node itself, and the features of
/// their edges: displacement and length.
struct GraphLevel {
  Matrix<float> positions;
  std::vector<std::int32_t> start;
  std::vector<std::int32_t> neighbour;
  Matrix<float> edges;
  /// The node of the next coarser level to which each belongs; empty in the coarsest.
  std::vector<std::int32_t> parent;

  Index nodes() const { return positions.rows(); }
};

/// What the network reads: the input and all that follows from it.
struct GraphSample {
  Matrix<float> features;
  /// From the viewpoint graph to its coarsest view.
  std::vector<GraphLevel> levels;
  std::int32_t current = 0;
  std::vector<std::int32_t> actions;
  Matrix<float> history;
  Eigen::VectorXf globals;

  Index nodes() const { return features.rows(); }
};

/// Adds a node itself to its list, edge features and `coarser_levels` of the pyramid. Throws
/// std::invalid_argument when indices or sizes do not agree, or there is no action.
GraphSample BuildSample(const GraphInput& input, int coarser_levels);

/// The next coarser level of `fine`, whose `parent` it fills. Nodes become seeds in the order of
/// their distance from `centre` unless a neighbour is one already; a seed takes all neighbours that
/// nobody took. So clusters never reach through walls, need no length to be chosen, and do not
/// depend on how nodes are numbered. Clusters are neighbours when any of their members are; their
/// position is the mean.
GraphLevel Coarsen(GraphLevel& fine, const Eigen::RowVector2f& centre);

}  // namespace hv::explore::nn
