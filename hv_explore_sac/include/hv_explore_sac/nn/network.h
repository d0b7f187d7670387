#pragma once

#include <vector>

#include "hv_explore_sac/nn/decoder.h"
#include "hv_explore_sac/nn/graph_sample.h"
#include "hv_explore_sac/nn/lstm.h"
#include "hv_explore_sac/nn/network_config.h"
#include "hv_explore_sac/nn/node_pyramid.h"

namespace hv::explore::nn {

/// What a network is made for: numbers per node and per state that it reads, scores per action
/// that it gives (one for an actor, two for twin critics).
struct NetworkShape {
  int node_features = 0;
  int globals = 0;
  int outputs = 1;
};

/// The spatiotemporal policy evaluation network (paper, section 3.3.4, Fig. 5): graph encoder,
/// node pyramid, memory of the visited nodes, pointer decoder. Actor and critics are instances of
/// it. Constant after construction and thread-safe; parameters are passed in, and each thread
/// brings its own Workspace.
template <typename Scalar>
class Network {
 public:
  /// Activations of one sample. Reused from sample to sample, it stops allocating once it has seen
  /// the largest one.
  struct Workspace {
    Arena<Scalar> arena;
    std::vector<LevelView<Scalar>> levels;
    std::vector<std::int32_t> all_nodes;
    std::int32_t all_start[2] = {0, 0};
    View<Scalar> features;
    View<Scalar> history;
    std::vector<typename EncoderLayer<Scalar>::Saved> encoder;
    typename LayerNorm<Scalar>::Saved encoder_norm;
    typename NodePyramid<Scalar>::Saved pyramid;
    typename Lstm<Scalar>::Saved lstm;
    typename PointerDecoder<Scalar>::Saved decoder;
  };

  Network(const NetworkConfig& config, const NetworkShape& shape);

  const ParameterLayout& layout() const { return layout_; }
  const NetworkConfig& config() const { return config_; }
  const NetworkShape& shape() const { return shape_; }

  /// Scores [actions x outputs], valid until the workspace is used again. `sample` must outlive the
  /// backward pass and have been built with at least the pyramid's levels. Throws
  /// std::invalid_argument for a sample of another shape.
  View<Scalar> Forward(const Scalar* parameters, const GraphSample& sample,
                       Workspace& workspace) const;
  /// Adds the gradient of the parameters, given that of the scores of the last forward pass.
  void Backward(const Scalar* parameters, View<const Scalar> d_scores, Workspace& workspace,
                Scalar* gradient) const;

 private:
  void Check(const GraphSample& sample) const;
  void Import(const GraphSample& sample, Workspace& workspace) const;
  typename PointerDecoder<Scalar>::Input DecoderInput(const GraphSample& sample,
                                                      View<const Scalar> nodes,
                                                      View<const Scalar> memory,
                                                      Workspace& workspace) const;

  NetworkConfig config_;
  NetworkShape shape_;
  ParameterLayout layout_;
  Linear<Scalar> embedding_;
  std::vector<EncoderLayer<Scalar>> encoder_;
  LayerNorm<Scalar> encoder_norm_;
  NodePyramid<Scalar> pyramid_;
  Lstm<Scalar> lstm_;
  PointerDecoder<Scalar> decoder_;
};

extern template class Network<float>;
extern template class Network<double>;

}  // namespace hv::explore::nn
