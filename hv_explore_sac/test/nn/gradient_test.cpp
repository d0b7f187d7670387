#include <random>

#include <gtest/gtest.h>

#include "gradient_check.h"
#include "hv_explore_sac/nn/attention.h"
#include "hv_explore_sac/nn/lstm.h"
#include "hv_explore_sac/nn/network.h"
#include "sample_graphs.h"

namespace hv::explore::nn {
namespace {

Vector<double> RandomVector(std::uint32_t seed, Index size) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  return Vector<double>::NullaryExpr(size, [&] { return 0.5 * normal(random); });
}

View<const double> Const(const Vector<double>& data, Index rows) {
  return {data.data(), rows, data.size() / rows};
}

/// A layer under test: from parameters and input to an output, and back.
struct Layer {
  std::function<View<double>(const double* parameters, Arena<double>&, View<const double> x)>
      forward;
  std::function<void(const Backprop<double>&, View<const double> d_y, View<double> d_x)> backward;
};

/// Random parameters and input, loss = <random weights, output>.
void CheckLayer(const Layer& layer, const ParameterLayout& layout, Index rows, Index cols,
                bool input_gradient = true) {
  Vector<double> parameters = RandomVector(1, layout.size());
  Vector<double> x = RandomVector(2, rows * cols);
  Vector<double> weights;
  const auto loss = [&] {
    Arena<double> arena;
    const View<double> y = layer.forward(parameters.data(), arena, Const(x, rows));
    if (weights.size() == 0) weights = RandomVector(3, y.size());
    return weights.dot(Eigen::Map<const Vector<double>>(y.data, y.size()));
  };
  loss();
  Arena<double> arena;
  const View<double> y = layer.forward(parameters.data(), arena, Const(x, rows));
  Vector<double> gradient = Vector<double>::Zero(layout.size());
  Vector<double> d_x = Vector<double>::Zero(x.size());
  layer.backward({parameters.data(), gradient.data(), arena}, {weights.data(), y.rows, y.cols},
                 {d_x.data(), rows, cols});
  ExpectGradient(loss, parameters, gradient, "parameters");
  if (input_gradient) ExpectGradient(loss, x, d_x, "input");
}

TEST(Gradient, Linear) {
  ParameterLayout layout;
  const Linear<double> linear(layout, "linear", 5, 7);
  View<const double> input;
  CheckLayer({[&](const double* parameters, Arena<double>& arena, View<const double> x) {
                input = x;
                const View<double> y = arena.Take(x.rows, 7);
                linear.Forward(parameters, x, y);
                return y;
              },
              [&](const Backprop<double>& pass, View<const double> d_y, View<double> d_x) {
                linear.Backward(pass, input, d_y, d_x);
              }},
             layout, 4, 5);
}

TEST(Gradient, LayerNorm) {
  ParameterLayout layout;
  const LayerNorm<double> norm(layout, "norm", 6);
  LayerNorm<double>::Saved saved;
  CheckLayer({[&](const double* parameters, Arena<double>& arena, View<const double> x) {
                return norm.Forward(parameters, arena, x, saved);
              },
              [&](const Backprop<double>& pass, View<const double> d_y, View<double> d_x) {
                norm.Backward(pass, saved, d_y, d_x);
              }},
             layout, 5, 6);
}

TEST(Gradient, FeedForward) {
  ParameterLayout layout;
  const FeedForward<double> feed_forward(layout, "feed_forward", 4, 9);
  FeedForward<double>::Saved saved;
  CheckLayer({[&](const double* parameters, Arena<double>& arena, View<const double> x) {
                return feed_forward.Forward(parameters, arena, x, saved);
              },
              [&](const Backprop<double>& pass, View<const double> d_y, View<double> d_x) {
                feed_forward.Backward(pass, saved, d_y, d_x);
              }},
             layout, 5, 4);
}

/// The lists and edges of a small random graph in double precision.
struct SmallGraph {
  explicit SmallGraph(Index nodes)
      : sample(BuildSample(RandomGraph(5, nodes, 2, 4), 0)),
        edges(sample.levels[0].edges.cast<double>()) {}
  NeighbourLists lists() const {
    const GraphLevel& level = sample.levels[0];
    return {level.nodes(), level.start.data(), level.neighbour.data()};
  }
  View<const double> edge_view() const { return {edges.data(), edges.rows(), edges.cols()}; }

  GraphSample sample;
  Matrix<double> edges;
};

/// Heads of 4 and of 16 columns take different loops.
class AttentionGradients : public testing::TestWithParam<Index> {};

TEST_P(AttentionGradients, OfOneSetOfNodes) {
  const SmallGraph graph(7);
  const Index width = GetParam();
  ParameterLayout layout;
  const NeighbourAttention<double> attention(layout, "attention", width, 2);
  NeighbourAttention<double>::Saved saved;
  CheckLayer({[&](const double* parameters, Arena<double>& arena, View<const double> x) {
                return attention.Forward(parameters, arena,
                                         {x, x, graph.lists(), graph.edge_view()}, saved);
              },
              [&](const Backprop<double>& pass, View<const double> d_y, View<double> d_x) {
                attention.Backward(pass, saved, d_y, d_x, d_x);
              }},
             layout, 7, width);
}

INSTANTIATE_TEST_SUITE_P(Widths, AttentionGradients, testing::Values(8, 32));

TEST(Gradient, EncoderLayer) {
  const SmallGraph graph(6);
  ParameterLayout layout;
  const EncoderLayer<double> encoder(layout, "encoder", 8, 2, 12);
  EncoderLayer<double>::Saved saved;
  CheckLayer({[&](const double* parameters, Arena<double>& arena, View<const double> x) {
                const View<double> y = arena.Take(x.rows, x.cols);
                y.matrix() = x.matrix();
                encoder.Forward(parameters, arena, graph.lists(), graph.edge_view(), y, saved);
                return y;
              },
              [&](const Backprop<double>& pass, View<const double> d_y, View<double> d_x) {
                d_x.matrix() = d_y.matrix();
                encoder.Backward(pass, saved, d_x);
              }},
             layout, 6, 8);
}

TEST(Gradient, LstmOverWindows) {
  for (const Index steps : {1, 6}) {
    ParameterLayout layout;
    const Lstm<double> lstm(layout, "lstm", 3, 4);
    Lstm<double>::Saved saved;
    CheckLayer({[&](const double* parameters, Arena<double>& arena, View<const double> x) {
                  return lstm.Forward(parameters, arena, x, saved);
                },
                [&](const Backprop<double>& pass, View<const double> d_y, View<double>) {
                  lstm.Backward(pass, saved, d_y);
                }},
               layout, steps, 3, false);
  }
}

/// The whole network in each of its forms, all parameters.
TEST(Gradient, Network) {
  const GraphSample sample = BuildSample(RandomGraph(9, 14, 3, 4), 2);
  NetworkConfig config{8, 2, 12, 2, 2, 4};
  for (const NetworkShape shape : {NetworkShape{3, 0, 1}, NetworkShape{3, 3, 2}}) {
    const Network<double> network(config, shape);
    Network<double>::Workspace workspace;
    Vector<double> parameters = RandomVector(4, network.layout().size());
    const Index count = static_cast<Index>(sample.actions.size()) * shape.outputs;
    const Vector<double> weights = RandomVector(5, count);
    const auto loss = [&] {
      const View<double> y = network.Forward(parameters.data(), sample, workspace);
      return weights.dot(Eigen::Map<const Vector<double>>(y.data, y.size()));
    };
    loss();
    Vector<double> gradient = Vector<double>::Zero(parameters.size());
    network.Backward(parameters.data(), {weights.data(), count / shape.outputs, shape.outputs},
                     workspace, gradient.data());
    ExpectGradient(loss, parameters, gradient, "network");
    config.pyramid_levels = 0;
    config.memory = 0;
  }
}

}  // namespace
}  // namespace hv::explore::nn
