#include "hv_explore_sac/nn/attention.h"

namespace hv::explore::nn {

template <typename Scalar>
NeighbourAttention<Scalar>::NeighbourAttention(ParameterLayout& layout, const std::string& name,
                                               Index width, Index heads)
    : query_(layout, name + ".query", width, width),
      key_value_(layout, name + ".key_value", width, 2 * width),
      output_(layout, name + ".output", width, width),
      edge_bias_(layout.Add(name + ".edge_bias", kEdgeFeatures, heads, Init::kGlorot)),
      heads_(heads) {}

template <typename Scalar>
View<Scalar> NeighbourAttention<Scalar>::Forward(const Scalar* parameters, Arena<Scalar>& arena,
                                                 const Input& input, Saved& saved) const {
  const Index width = input.queries.cols;
  saved.input = input;
  saved.q = arena.Take(input.queries.rows, width);
  query_.Forward(parameters, input.queries, saved.q);
  saved.kv = arena.Take(input.memory.rows, 2 * width);
  key_value_.Forward(parameters, input.memory, saved.kv);
  saved.weights = arena.TakeZero(input.lists.edges(), heads_);
  AddProduct<Scalar>(input.edges, edge_bias_.In(parameters), saved.weights);
  const AttentionInput<Scalar> attention{input.lists, heads_, saved.q, saved.kv};
  AttentionWeights(attention, saved.weights);
  saved.mixed = arena.Take(input.queries.rows, width);
  MixValues<Scalar>(attention, saved.weights, saved.mixed);
  const View<Scalar> y = arena.Take(input.queries.rows, width);
  output_.Forward(parameters, saved.mixed, y);
  return y;
}

template <typename Scalar>
void NeighbourAttention<Scalar>::Backward(const Backprop<Scalar>& pass, const Saved& saved,
                                          View<const Scalar> d_y, View<Scalar> d_queries,
                                          View<Scalar> d_memory) const {
  const typename Arena<Scalar>::Scope scope(pass.arena);
  const View<Scalar> d_mixed = pass.arena.TakeZero(saved.mixed.rows, saved.mixed.cols);
  output_.Backward(pass, saved.mixed, d_y, d_mixed);
  const View<Scalar> d_q = pass.arena.TakeZero(saved.q.rows, saved.q.cols);
  const View<Scalar> d_kv = pass.arena.TakeZero(saved.kv.rows, saved.kv.cols);
  const AttentionInput<Scalar> attention{saved.input.lists, heads_, saved.q, saved.kv};
  AttentionBackward<Scalar>(attention, saved.mixed, d_mixed, saved.weights, {d_q, d_kv});
  AddTransposedProduct<Scalar>(saved.input.edges, saved.weights, edge_bias_.In(pass.gradient));
  query_.Backward(pass, saved.input.queries, d_q, d_queries);
  key_value_.Backward(pass, saved.input.memory, d_kv, d_memory);
}

template <typename Scalar>
EncoderLayer<Scalar>::EncoderLayer(ParameterLayout& layout, const std::string& name, Index width,
                                   Index heads, Index hidden)
    : norm_attention_(layout, name + ".norm_attention", width),
      attention_(layout, name + ".attention", width, heads),
      norm_feed_forward_(layout, name + ".norm_feed_forward", width),
      feed_forward_(layout, name + ".feed_forward", width, hidden) {}

template <typename Scalar>
void EncoderLayer<Scalar>::Forward(const Scalar* parameters, Arena<Scalar>& arena,
                                   const NeighbourLists& lists, View<const Scalar> edges,
                                   View<Scalar> x, Saved& saved) const {
  const View<Scalar> near = norm_attention_.Forward(parameters, arena, x, saved.norm_attention);
  x.matrix() +=
      attention_.Forward(parameters, arena, {near, near, lists, edges}, saved.attention).matrix();
  const View<Scalar> own =
      norm_feed_forward_.Forward(parameters, arena, x, saved.norm_feed_forward);
  x.matrix() += feed_forward_.Forward(parameters, arena, own, saved.feed_forward).matrix();
}

template <typename Scalar>
void EncoderLayer<Scalar>::Backward(const Backprop<Scalar>& pass, const Saved& saved,
                                    View<Scalar> d_x) const {
  const typename Arena<Scalar>::Scope scope(pass.arena);
  const View<Scalar> d_norm = pass.arena.TakeZero(d_x.rows, d_x.cols);
  feed_forward_.Backward(pass, saved.feed_forward, d_x, d_norm);
  norm_feed_forward_.Backward(pass, saved.norm_feed_forward, d_norm, d_x);
  d_norm.matrix().setZero();
  attention_.Backward(pass, saved.attention, d_x, d_norm, d_norm);
  norm_attention_.Backward(pass, saved.norm_attention, d_norm, d_x);
}

template class NeighbourAttention<float>;
template class NeighbourAttention<double>;
template class EncoderLayer<float>;
template class EncoderLayer<double>;

}  // namespace hv::explore::nn
