#include "hv_explore_sac/nn/network.h"

#include <numeric>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "sample_graphs.h"

namespace hv::explore::nn {
namespace {

const NetworkShape kShape{4, 0, 2};

/// Parameters of a size at which no part of the network is idle.
Eigen::VectorXf LivelyParameters(const Network<float>& network) {
  std::mt19937 random(7);
  return network.layout().Initial(3) + 0.1F * RandomMatrix(random, network.layout().size(), 1);
}

Matrix<float> Scores(const Network<float>& network, const GraphInput& input) {
  Network<float>::Workspace workspace;
  const GraphSample sample = BuildSample(input, network.config().pyramid_levels);
  return network.Forward(LivelyParameters(network).data(), sample, workspace).matrix();
}

/// The same graph with node i under the number `number[i]`.
GraphInput Renumber(const GraphInput& graph, const std::vector<std::int32_t>& number) {
  GraphInput other = graph;
  const auto nodes = static_cast<std::size_t>(graph.features.rows());
  std::vector<std::size_t> old(nodes);
  for (std::size_t i = 0; i < nodes; ++i) old[static_cast<std::size_t>(number[i])] = i;
  other.start = {0};
  other.neighbour.clear();
  for (std::size_t i = 0; i < nodes; ++i) {
    const auto from = static_cast<Index>(old[i]);
    other.features.row(static_cast<Index>(i)) = graph.features.row(from);
    other.positions.row(static_cast<Index>(i)) = graph.positions.row(from);
    for (std::int32_t e = graph.start[old[i]]; e < graph.start[old[i] + 1]; ++e) {
      const auto neighbour = static_cast<std::size_t>(graph.neighbour[static_cast<std::size_t>(e)]);
      other.neighbour.push_back(number[neighbour]);
    }
    other.start.push_back(static_cast<std::int32_t>(other.neighbour.size()));
  }
  other.current = number[static_cast<std::size_t>(graph.current)];
  for (std::int32_t& action : other.actions) action = number[static_cast<std::size_t>(action)];
  return other;
}

TEST(Network, DoesNotDependOnHowNodesAreNumbered) {
  const Network<float> network({}, kShape);
  const GraphInput graph = RandomGraph(11, 120, 4, 8);
  std::vector<std::int32_t> number(120);
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), std::mt19937(5));
  const Matrix<float> scores = Scores(network, graph);
  const float scale = scores.cwiseAbs().maxCoeff();
  EXPECT_LT((Scores(network, Renumber(graph, number)) - scores).cwiseAbs().maxCoeff(),
            1e-5F * scale);
}

TEST(Network, ScoresFollowTheOrderOfActionsAndNoOtherOrder) {
  const Network<float> network({}, kShape);
  GraphInput graph = RandomGraph(12, 60, 4, 8);
  const Matrix<float> scores = Scores(network, graph);
  for (std::size_t i = 0; i + 1 < graph.start.size(); ++i) {
    std::reverse(graph.neighbour.begin() + graph.start[i],
                 graph.neighbour.begin() + graph.start[i + 1]);
  }
  std::reverse(graph.actions.begin(), graph.actions.end());
  const Matrix<float> reversed = Scores(network, graph);
  EXPECT_LT((reversed.colwise().reverse() - scores).cwiseAbs().maxCoeff(),
            1e-5F * scores.cwiseAbs().maxCoeff());
}

/// Each part must matter, or a test of the whole would not notice its absence.
TEST(Network, EveryInputReachesTheScores) {
  const Network<float> network({}, {4, 3, 2});
  const GraphInput graph = RandomGraph(13, 100, 4, 6);
  const Matrix<float> scores = Scores(network, graph);
  const auto expect_changed = [&](const GraphInput& other, const char* what) {
    EXPECT_GT((Scores(network, other) - scores).cwiseAbs().maxCoeff(), 1e-4F) << what;
  };
  GraphInput other = graph;
  other.features(99, 0) += 1.0F;
  expect_changed(other, "features");
  other = graph;
  other.positions.row(50) *= 1.2F;
  expect_changed(other, "positions");
  other = graph;
  other.history(0, 0) += 1.0F;
  expect_changed(other, "history");
  other = graph;
  other.history = graph.history.topRows(0);
  expect_changed(other, "no history");
  other = graph;
  other.globals[2] += 1.0F;
  expect_changed(other, "globals");
}

TEST(Network, StopsAllocatingOnceWarm) {
  const Network<float> network({}, kShape);
  const Eigen::VectorXf parameters = network.layout().Initial(1);
  Eigen::VectorXf gradient = Eigen::VectorXf::Zero(parameters.size());
  Network<float>::Workspace workspace;
  std::size_t warm = 0;
  for (const Index nodes : {300, 20, 299, 150, 300}) {
    const GraphSample sample =
        BuildSample(RandomGraph(static_cast<std::uint32_t>(nodes), nodes, 4), 2);
    const View<float> scores = network.Forward(parameters.data(), sample, workspace);
    network.Backward(parameters.data(), scores, workspace, gradient.data());
    if (warm == 0) warm = workspace.arena.allocations();
    EXPECT_EQ(workspace.arena.allocations(), warm);
  }
}

TEST(Network, FloatAndDoubleAgree) {
  const Network<float> network({}, kShape);
  const Network<double> exact({}, kShape);
  const GraphSample sample = BuildSample(RandomGraph(14, 80, 4), 2);
  const Eigen::VectorXf parameters = LivelyParameters(network);
  const Eigen::VectorXd exact_parameters = parameters.cast<double>();
  Network<float>::Workspace workspace;
  Network<double>::Workspace exact_workspace;
  const View<float> scores = network.Forward(parameters.data(), sample, workspace);
  const View<double> expected = exact.Forward(exact_parameters.data(), sample, exact_workspace);
  EXPECT_LT((scores.matrix().cast<double>() - expected.matrix()).cwiseAbs().maxCoeff(),
            1e-5 * expected.matrix().cwiseAbs().maxCoeff());
}

TEST(Network, RefusesSamplesOfAnotherShape) {
  Network<float>::Workspace workspace;
  const GraphSample sample = BuildSample(RandomGraph(15, 20, 4, 5, 2, 1), 1);
  const NetworkConfig shallow{8, 2, 8, 1, 1, 4};
  const auto run = [&](const NetworkConfig& config, const NetworkShape& shape) {
    const Network<float> network(config, shape);
    network.Forward(network.layout().Initial(1).data(), sample, workspace);
  };
  EXPECT_NO_THROW(run(shallow, {4, 1, 1}));
  EXPECT_THROW(run(shallow, {5, 1, 1}), std::invalid_argument);
  EXPECT_THROW(run(shallow, {4, 2, 1}), std::invalid_argument);
  EXPECT_THROW(run({8, 2, 8, 1, 2, 4}, {4, 1, 1}), std::invalid_argument);
}

TEST(Network, StartsFromItsSeed) {
  const Network<float> network({}, kShape);
  const ParameterLayout& layout = network.layout();
  EXPECT_EQ(layout.Initial(4), layout.Initial(4));
  EXPECT_NE(layout.Initial(4), layout.Initial(5));
  std::set<std::string> names;
  Index next = 0;
  for (const ParameterLayout::Block& block : layout.blocks()) {
    EXPECT_TRUE(names.insert(block.name).second) << block.name;
    EXPECT_EQ(block.slot.offset, next);
    next += block.slot.rows * block.slot.cols;
  }
  EXPECT_EQ(next, layout.size());
}

}  // namespace
}  // namespace hv::explore::nn
