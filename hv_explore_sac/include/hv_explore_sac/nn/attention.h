#pragma once

#include <string>

#include "hv_explore_sac/nn/kernels.h"
#include "hv_explore_sac/nn/layers.h"

namespace hv::explore::nn {

/// Numbers of an edge: displacement from the query's node to the neighbour (x, y) and its length.
constexpr Index kEdgeFeatures = 3;

/// Multi-head attention over neighbour lists. It equals dense attention under the adjacency mask
/// (paper, section 3.3.4) at the cost of the edges instead of all pairs. The score of an edge also
/// has a bias, linear in the edge's features, one per head: so heads can prefer a direction or the
/// near, and the edge weights of the graph (Eq. 12) enter.
template <typename Scalar>
class NeighbourAttention {
 public:
  struct Input {
    View<const Scalar> queries;
    View<const Scalar> memory;
    NeighbourLists lists;
    /// [edges x kEdgeFeatures]
    View<const Scalar> edges;
  };
  struct Saved {
    Input input;
    View<Scalar> q;
    View<Scalar> kv;
    View<Scalar> weights;
    View<Scalar> mixed;
  };

  NeighbourAttention() = default;
  NeighbourAttention(ParameterLayout& layout, const std::string& name, Index width, Index heads);

  /// [queries x width]
  View<Scalar> Forward(const Scalar* parameters, Arena<Scalar>& arena, const Input& input,
                       Saved& saved) const;
  /// Both gradients are added to and may be the same. Consumes `saved`.
  void Backward(const Backprop<Scalar>& pass, const Saved& saved, View<const Scalar> d_y,
                View<Scalar> d_queries, View<Scalar> d_memory) const;

 private:
  Linear<Scalar> query_;
  Linear<Scalar> key_value_;
  Linear<Scalar> output_;
  Slot edge_bias_;
  Index heads_ = 1;
};

/// A transformer layer with normalisation ahead of each part:
/// x += attention(norm(x)); x += feed_forward(norm(x)).
template <typename Scalar>
class EncoderLayer {
 public:
  struct Saved {
    typename LayerNorm<Scalar>::Saved norm_attention;
    typename NeighbourAttention<Scalar>::Saved attention;
    typename LayerNorm<Scalar>::Saved norm_feed_forward;
    typename FeedForward<Scalar>::Saved feed_forward;
  };

  EncoderLayer(ParameterLayout& layout, const std::string& name, Index width, Index heads,
               Index hidden);

  /// Works on `x` in place.
  void Forward(const Scalar* parameters, Arena<Scalar>& arena, const NeighbourLists& lists,
               View<const Scalar> edges, View<Scalar> x, Saved& saved) const;
  /// Turns the gradient of the outcome into that of the input, in place.
  void Backward(const Backprop<Scalar>& pass, const Saved& saved, View<Scalar> d_x) const;

 private:
  LayerNorm<Scalar> norm_attention_;
  NeighbourAttention<Scalar> attention_;
  LayerNorm<Scalar> norm_feed_forward_;
  FeedForward<Scalar> feed_forward_;
};

extern template class NeighbourAttention<float>;
extern template class NeighbourAttention<double>;
extern template class EncoderLayer<float>;
extern template class EncoderLayer<double>;

}  // namespace hv::explore::nn
