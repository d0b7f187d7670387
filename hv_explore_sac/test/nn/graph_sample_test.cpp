#include "hv_explore_sac/nn/graph_sample.h"

#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

#include "sample_graphs.h"

namespace hv::explore::nn {
namespace {

/// A row of nodes one apart, neighbours joined.
GraphInput Row(Index nodes) {
  GraphInput graph;
  graph.features = Matrix<float>::Zero(nodes, 2);
  graph.positions = Matrix<float>::Zero(nodes, 2);
  for (Index i = 0; i < nodes; ++i) {
    graph.positions(i, 0) = static_cast<float>(i);
    if (i > 0) graph.neighbour.push_back(static_cast<std::int32_t>(i - 1));
    if (i + 1 < nodes) graph.neighbour.push_back(static_cast<std::int32_t>(i + 1));
    graph.start.push_back(static_cast<std::int32_t>(graph.neighbour.size()));
  }
  graph.actions = {1};
  return graph;
}

TEST(GraphSample, ListsBeginWithTheNodeAndEdgesMeasureTheWay) {
  const GraphSample sample = BuildSample(Row(3), 0);
  const GraphLevel& level = sample.levels[0];
  EXPECT_EQ(level.start, (std::vector<std::int32_t>{0, 2, 5, 7}));
  EXPECT_EQ(level.neighbour, (std::vector<std::int32_t>{0, 1, 1, 0, 2, 2, 1}));
  EXPECT_EQ(Eigen::RowVector3f(level.edges.row(0)), Eigen::RowVector3f(0, 0, 0));
  EXPECT_EQ(Eigen::RowVector3f(level.edges.row(1)), Eigen::RowVector3f(1, 0, 1));
  EXPECT_EQ(Eigen::RowVector3f(level.edges.row(3)), Eigen::RowVector3f(-1, 0, 1));
}

TEST(GraphSample, ClustersGrowFromTheCurrentNode) {
  const GraphSample sample = BuildSample(Row(7), 2);
  EXPECT_EQ(sample.levels[0].parent, (std::vector<std::int32_t>{0, 0, 1, 1, 2, 2, 3}));
  const GraphLevel& coarse = sample.levels[1];
  EXPECT_EQ(coarse.neighbour, (std::vector<std::int32_t>{0, 1, 1, 0, 2, 2, 1, 3, 3, 2}));
  EXPECT_FLOAT_EQ(coarse.positions(1, 0), 2.5F);
  EXPECT_EQ(coarse.parent, (std::vector<std::int32_t>{0, 0, 1, 1}));
  EXPECT_EQ(sample.levels[2].nodes(), 2);
  EXPECT_TRUE(sample.levels[2].parent.empty());
}

/// Close in space, but without an edge: as on the two sides of a wall.
TEST(GraphSample, ClustersDoNotReachThroughWalls) {
  GraphInput graph = Row(2);
  graph.positions.setZero();
  graph.start = {0, 0, 0};
  graph.neighbour.clear();
  const GraphSample sample = BuildSample(graph, 1);
  EXPECT_EQ(sample.levels[1].nodes(), 2);
}

TEST(GraphSample, CoarseLevelsKeepWhatIsConnected) {
  const GraphSample sample = BuildSample(RandomGraph(4, 200, 3, 6), 2);
  for (std::size_t l = 0; l + 1 < sample.levels.size(); ++l) {
    const GraphLevel& fine = sample.levels[l];
    const GraphLevel& coarse = sample.levels[l + 1];
    EXPECT_LT(coarse.nodes(), fine.nodes());
    for (std::size_t i = 0; i < fine.parent.size(); ++i) {
      const auto parent = static_cast<std::size_t>(fine.parent[i]);
      const std::set<std::int32_t> joined(coarse.neighbour.begin() + coarse.start[parent],
                                          coarse.neighbour.begin() + coarse.start[parent + 1]);
      for (std::int32_t e = fine.start[i]; e < fine.start[i + 1]; ++e) {
        const auto other = static_cast<std::size_t>(fine.neighbour[static_cast<std::size_t>(e)]);
        EXPECT_EQ(joined.count(fine.parent[other]), 1U);
      }
    }
  }
}

TEST(GraphSample, ASingleNodeIsAGraph) {
  GraphInput graph = Row(1);
  graph.actions = {0};
  const GraphSample sample = BuildSample(graph, 3);
  EXPECT_EQ(sample.levels.back().nodes(), 1);
}

TEST(GraphSample, RefusesWhatDoesNotFit) {
  const auto refused = [](const std::function<void(GraphInput&)>& spoil) {
    GraphInput graph = Row(4);
    spoil(graph);
    EXPECT_THROW(BuildSample(graph, 1), std::invalid_argument);
  };
  refused([](GraphInput& graph) { graph.features.resize(0, 2); });
  refused([](GraphInput& graph) { graph.positions.resize(3, 2); });
  refused([](GraphInput& graph) { graph.start.pop_back(); });
  refused([](GraphInput& graph) { graph.start[1] = 5; });
  refused([](GraphInput& graph) { graph.neighbour[0] = 4; });
  refused([](GraphInput& graph) { graph.neighbour[0] = -1; });
  refused([](GraphInput& graph) { graph.current = 4; });
  refused([](GraphInput& graph) { graph.actions = {}; });
  refused([](GraphInput& graph) { graph.actions = {9}; });
  refused([](GraphInput& graph) { graph.history = Matrix<float>::Zero(2, 3); });
}

}  // namespace
}  // namespace hv::explore::nn
