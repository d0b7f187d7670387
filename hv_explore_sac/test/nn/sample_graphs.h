#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "hv_explore_sac/nn/graph_sample.h"

namespace hv::explore::nn {

inline Matrix<float> RandomMatrix(std::mt19937& random, Index rows, Index cols) {
  std::normal_distribution<float> normal;
  return Matrix<float>::NullaryExpr(rows, cols, [&] { return normal(random); });
}

/// Nodes scattered at about one a unit square, each with its `most` nearest neighbours; the robot
/// is at the first node and may go to its neighbours.
inline GraphInput RandomGraph(std::uint32_t seed, Index nodes, Index features, Index most = 19,
                              Index history = 5, Index globals = 3) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(0.0F, std::sqrt(static_cast<float>(nodes)));
  GraphInput graph;
  graph.features = RandomMatrix(random, nodes, features);
  graph.positions = Matrix<float>::NullaryExpr(nodes, 2, [&] { return place(random); });
  for (Index i = 0; i < nodes; ++i) {
    std::vector<std::pair<float, std::int32_t>> others;
    for (Index j = 0; j < nodes; ++j) {
      if (i == j) continue;
      others.emplace_back((graph.positions.row(i) - graph.positions.row(j)).norm(),
                          static_cast<std::int32_t>(j));
    }
    std::sort(others.begin(), others.end());
    others.resize(std::min(others.size(), static_cast<std::size_t>(most)));
    for (const auto& other : others) graph.neighbour.push_back(other.second);
    graph.start.push_back(static_cast<std::int32_t>(graph.neighbour.size()));
  }
  graph.actions.assign(graph.neighbour.begin(), graph.neighbour.begin() + graph.start[1]);
  graph.history = RandomMatrix(random, history, features);
  graph.globals = RandomMatrix(random, globals, 1);
  return graph;
}

}  // namespace hv::explore::nn
