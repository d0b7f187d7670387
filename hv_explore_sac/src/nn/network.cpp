#include "hv_explore_sac/nn/network.h"

#include <numeric>
#include <stdexcept>

namespace hv::explore::nn {
namespace {

/// A copy of `matrix` in the arena, in the network's precision.
template <typename Scalar, typename Derived>
View<Scalar> Copy(Arena<Scalar>& arena, const Eigen::MatrixBase<Derived>& matrix) {
  const View<Scalar> copy = arena.Take(matrix.rows(), matrix.cols());
  copy.matrix() = matrix.template cast<Scalar>();
  return copy;
}

template <typename Scalar>
std::vector<EncoderLayer<Scalar>> EncoderLayers(ParameterLayout& layout,
                                                const NetworkConfig& config) {
  std::vector<EncoderLayer<Scalar>> layers;
  for (int i = 0; i < config.encoder_layers; ++i) {
    layers.emplace_back(layout, "encoder" + std::to_string(i), config.width, config.heads,
                        config.feed_forward);
  }
  return layers;
}

}  // namespace

template <typename Scalar>
Network<Scalar>::Network(const NetworkConfig& config, const NetworkShape& shape)
    : config_(config),
      shape_(shape),
      embedding_(layout_, "embedding", shape.node_features, config.width),
      encoder_(EncoderLayers<Scalar>(layout_, config)),
      encoder_norm_(layout_, "encoder_norm", config.width),
      pyramid_(layout_, "pyramid", config.width, config.heads, config.feed_forward,
               config.pyramid_levels),
      lstm_(layout_, "memory", shape.node_features, config.memory),
      decoder_(layout_, "decoder", config.width, config.heads, config.memory, shape.globals,
               shape.outputs) {}

template <typename Scalar>
View<Scalar> Network<Scalar>::Forward(const Scalar* parameters, const GraphSample& sample,
                                      Workspace& workspace) const {
  Check(sample);
  Arena<Scalar>& arena = workspace.arena;
  arena.Reset();
  Import(sample, workspace);
  const View<Scalar> x = arena.Take(sample.nodes(), config_.width);
  embedding_.Forward(parameters, workspace.features, x);
  workspace.encoder.resize(encoder_.size());
  for (std::size_t i = 0; i < encoder_.size(); ++i) {
    encoder_[i].Forward(parameters, arena, workspace.levels[0].lists, workspace.levels[0].edges, x,
                        workspace.encoder[i]);
  }
  const View<Scalar> encoded = encoder_norm_.Forward(parameters, arena, x, workspace.encoder_norm);
  const View<Scalar> fused =
      pyramid_.Forward(parameters, arena, workspace.levels, encoded, workspace.pyramid);
  const View<Scalar> memory = lstm_.Forward(parameters, arena, workspace.history, workspace.lstm);
  return decoder_.Forward(parameters, arena, DecoderInput(sample, fused, memory, workspace),
                          workspace.decoder);
}

template <typename Scalar>
void Network<Scalar>::Backward(const Scalar* parameters, View<const Scalar> d_scores,
                               Workspace& workspace, Scalar* gradient) const {
  const typename Arena<Scalar>::Scope scope(workspace.arena);
  const Backprop<Scalar> pass{parameters, gradient, workspace.arena};
  const View<Scalar> d_nodes = workspace.arena.TakeZero(workspace.features.rows, config_.width);
  const View<Scalar> d_memory = workspace.arena.TakeZero(1, config_.memory);
  decoder_.Backward(pass, workspace.decoder, d_scores, d_nodes, d_memory);
  lstm_.Backward(pass, workspace.lstm, d_memory);
  pyramid_.Backward(pass, workspace.levels, workspace.pyramid, d_nodes);
  const View<Scalar> d_x = workspace.arena.TakeZero(d_nodes.rows, d_nodes.cols);
  encoder_norm_.Backward(pass, workspace.encoder_norm, d_nodes, d_x);
  for (std::size_t i = encoder_.size(); i-- > 0;) {
    encoder_[i].Backward(pass, workspace.encoder[i], d_x);
  }
  embedding_.Backward(pass, workspace.features, d_x, {});
}

template <typename Scalar>
void Network<Scalar>::Check(const GraphSample& sample) const {
  if (sample.features.cols() != shape_.node_features) {
    throw std::invalid_argument("a sample of " + std::to_string(sample.features.cols()) +
                                " node features for a network of " +
                                std::to_string(shape_.node_features));
  }
  if (sample.globals.size() < shape_.globals) {
    throw std::invalid_argument("a sample lacks the state features that the network reads");
  }
  if (static_cast<int>(sample.levels.size()) <= config_.pyramid_levels) {
    throw std::invalid_argument("a sample lacks levels of the pyramid");
  }
}

template <typename Scalar>
void Network<Scalar>::Import(const GraphSample& sample, Workspace& workspace) const {
  Arena<Scalar>& arena = workspace.arena;
  workspace.features = Copy(arena, sample.features);
  workspace.history = arena.Take(sample.history.rows(), shape_.node_features);
  if (sample.history.rows() > 0) {
    workspace.history.matrix() = sample.history.cast<Scalar>();
  }
  workspace.levels.resize(static_cast<std::size_t>(config_.pyramid_levels) + 1);
  for (std::size_t l = 0; l < workspace.levels.size(); ++l) {
    const GraphLevel& level = sample.levels[l];
    workspace.levels[l] = {{level.nodes(), level.start.data(), level.neighbour.data()},
                           Copy(arena, level.edges),
                           level.parent.data()};
  }
}

template <typename Scalar>
typename PointerDecoder<Scalar>::Input Network<Scalar>::DecoderInput(const GraphSample& sample,
                                                                     View<const Scalar> nodes,
                                                                     View<const Scalar> memory,
                                                                     Workspace& workspace) const {
  const Index count = sample.nodes();
  workspace.all_nodes.resize(static_cast<std::size_t>(count));
  std::iota(workspace.all_nodes.begin(), workspace.all_nodes.end(), 0);
  workspace.all_start[1] = static_cast<std::int32_t>(count);
  const Matrix<float>& positions = sample.levels[0].positions;
  const View<Scalar> to_all = workspace.arena.Take(count, kEdgeFeatures);
  for (Index i = 0; i < count; ++i) {
    const Eigen::RowVector2f way = positions.row(i) - positions.row(sample.current);
    Scalar* const edge = to_all.row(i);
    edge[0] = way.x();
    edge[1] = way.y();
    edge[2] = way.norm();
  }
  const View<Scalar> globals =
      Copy(workspace.arena, sample.globals.head(shape_.globals).transpose());
  return {nodes,
          sample.current,
          sample.actions.data(),
          static_cast<Index>(sample.actions.size()),
          to_all,
          {1, workspace.all_start, workspace.all_nodes.data()},
          memory,
          globals};
}

template class Network<float>;
template class Network<double>;

}  // namespace hv::explore::nn
