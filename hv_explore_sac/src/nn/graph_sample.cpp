#include "hv_explore_sac/nn/graph_sample.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>
#include <tuple>

namespace hv::explore::nn {
namespace {

void Require(bool condition, const char* what) {
  if (!condition) throw std::invalid_argument(std::string("graph sample: ") + what);
}

bool AllBelow(const std::vector<std::int32_t>& indices, Index count) {
  return std::all_of(indices.begin(), indices.end(),
                     [count](std::int32_t index) { return index >= 0 && index < count; });
}

void Check(const GraphInput& input) {
  const Index nodes = input.features.rows();
  Require(nodes > 0, "holds no node");
  Require(input.positions.rows() == nodes && input.positions.cols() == 2,
          "needs one position of two numbers a node");
  Require(static_cast<Index>(input.start.size()) == nodes + 1 && input.start.front() == 0 &&
              std::is_sorted(input.start.begin(), input.start.end()) &&
              input.start.back() == static_cast<std::int32_t>(input.neighbour.size()),
          "neighbour lists do not fit their starts");
  Require(AllBelow(input.neighbour, nodes) && AllBelow(input.actions, nodes) &&
              AllBelow({input.current}, nodes),
          "names a node that is not there");
  Require(!input.actions.empty(), "needs an action");
  Require(input.history.rows() == 0 || input.history.cols() == input.features.cols(),
          "needs a history of the nodes' features");
}

void FillEdges(GraphLevel& level) {
  level.edges.resize(static_cast<Index>(level.neighbour.size()), 3);
  for (std::size_t i = 0; i + 1 < level.start.size(); ++i) {
    for (Index e = level.start[i]; e < level.start[i + 1]; ++e) {
      const Eigen::RowVector2f way =
          level.positions.row(level.neighbour[static_cast<std::size_t>(e)]) -
          level.positions.row(static_cast<Index>(i));
      level.edges.row(e) << way.x(), way.y(), way.norm();
    }
  }
}

GraphLevel FinestLevel(const GraphInput& input) {
  GraphLevel level;
  level.positions = input.positions;
  level.start = {0};
  for (Index i = 0; i < input.features.rows(); ++i) {
    level.neighbour.push_back(static_cast<std::int32_t>(i));
    const auto at = static_cast<std::size_t>(i);
    for (std::int32_t e = input.start[at]; e < input.start[at + 1]; ++e) {
      const std::int32_t neighbour = input.neighbour[static_cast<std::size_t>(e)];
      if (neighbour != i) level.neighbour.push_back(neighbour);
    }
    level.start.push_back(static_cast<std::int32_t>(level.neighbour.size()));
  }
  FillEdges(level);
  return level;
}

/// From near `centre` to far; equal distances in the order of their coordinates.
std::vector<std::int32_t> OrderFrom(const Matrix<float>& positions,
                                    const Eigen::RowVector2f& centre) {
  std::vector<std::int32_t> order(static_cast<std::size_t>(positions.rows()));
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](std::int32_t i) {
    return std::make_tuple((positions.row(i) - centre).squaredNorm(), positions(i, 0),
                           positions(i, 1), i);
  };
  std::sort(order.begin(), order.end(),
            [&key](std::int32_t a, std::int32_t b) { return key(a) < key(b); });
  return order;
}

/// Fills the parents of `fine` and tells how many there are.
std::int32_t FormClusters(GraphLevel& fine, const Eigen::RowVector2f& centre) {
  constexpr std::int32_t kNone = -1;
  fine.parent.assign(static_cast<std::size_t>(fine.nodes()), kNone);
  std::int32_t clusters = 0;
  for (const std::int32_t seed : OrderFrom(fine.positions, centre)) {
    const auto at = static_cast<std::size_t>(seed);
    if (fine.parent[at] != kNone) continue;
    for (std::int32_t e = fine.start[at]; e < fine.start[at + 1]; ++e) {
      std::int32_t& parent =
          fine.parent[static_cast<std::size_t>(fine.neighbour[static_cast<std::size_t>(e)])];
      if (parent == kNone) parent = clusters;
    }
    ++clusters;
  }
  return clusters;
}

/// Lists of the clusters: each itself, then those to which an edge of a member leads, in order.
void JoinClusters(const GraphLevel& fine, GraphLevel& coarse) {
  std::vector<std::vector<std::int32_t>> lists(static_cast<std::size_t>(coarse.nodes()));
  for (std::size_t i = 0; i < fine.parent.size(); ++i) {
    for (std::int32_t e = fine.start[i]; e < fine.start[i + 1]; ++e) {
      const auto other = static_cast<std::size_t>(fine.neighbour[static_cast<std::size_t>(e)]);
      if (fine.parent[other] == fine.parent[i]) continue;
      lists[static_cast<std::size_t>(fine.parent[i])].push_back(fine.parent[other]);
    }
  }
  coarse.start = {0};
  for (std::size_t cluster = 0; cluster < lists.size(); ++cluster) {
    std::vector<std::int32_t>& list = lists[cluster];
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    coarse.neighbour.push_back(static_cast<std::int32_t>(cluster));
    coarse.neighbour.insert(coarse.neighbour.end(), list.begin(), list.end());
    coarse.start.push_back(static_cast<std::int32_t>(coarse.neighbour.size()));
  }
}

}  // namespace

GraphLevel Coarsen(GraphLevel& fine, const Eigen::RowVector2f& centre) {
  const std::int32_t clusters = FormClusters(fine, centre);
  GraphLevel coarse;
  coarse.positions = Matrix<float>::Zero(clusters, 2);
  Eigen::VectorXf members = Eigen::VectorXf::Zero(clusters);
  for (Index i = 0; i < fine.nodes(); ++i) {
    const std::int32_t parent = fine.parent[static_cast<std::size_t>(i)];
    coarse.positions.row(parent) += fine.positions.row(i);
    members[parent] += 1.0F;
  }
  coarse.positions.array().colwise() /= members.array();
  JoinClusters(fine, coarse);
  FillEdges(coarse);
  return coarse;
}

GraphSample BuildSample(const GraphInput& input, int coarser_levels) {
  Check(input);
  GraphSample sample{input.features, {},           input.current, input.actions,
                     input.history,  input.globals};
  sample.levels.push_back(FinestLevel(input));
  const Eigen::RowVector2f centre = input.positions.row(input.current);
  for (int level = 0; level < coarser_levels; ++level) {
    sample.levels.push_back(Coarsen(sample.levels.back(), centre));
  }
  return sample;
}

}  // namespace hv::explore::nn
