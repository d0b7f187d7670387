#include "hv_explore_sac/nn/decoder.h"

namespace hv::explore::nn {

template <typename Scalar>
PointerDecoder<Scalar>::PointerDecoder(ParameterLayout& layout, const std::string& name,
                                       Index width, Index heads, Index memory, Index globals,
                                       Index outputs)
    : width_(width),
      attention_(layout, name + ".attention", width, heads),
      state_(layout, name + ".state", 2 * width + memory + globals, width),
      pointer_(layout, name + ".pointer", 2 * width + kEdgeFeatures, outputs * width),
      score_(layout.Add(name + ".score.weight", width, outputs, Init::kSmall)),
      score_bias_(layout.Add(name + ".score.bias", 1, outputs, Init::kZero)) {}

template <typename Scalar>
View<Scalar> PointerDecoder<Scalar>::Forward(const Scalar* parameters, Arena<Scalar>& arena,
                                             const Input& input, Saved& saved) const {
  saved.input = input;
  const View<const Scalar> current(input.nodes.row(input.current), 1, width_);
  const View<Scalar> context = attention_.Forward(
      parameters, arena, {current, input.nodes, input.all, input.to_all}, saved.attention);
  JoinState(arena, input, context, saved);
  saved.state = arena.Take(1, width_);
  state_.Forward(parameters, saved.joined, saved.state);
  Relu(saved.state);
  JoinPointer(arena, input, saved);
  saved.hidden = arena.Take(input.action_count, pointer_.outputs());
  pointer_.Forward(parameters, saved.pointer_input, saved.hidden);
  Relu(saved.hidden);
  const View<Scalar> scores = arena.Take(input.action_count, score_.cols);
  for (Index output = 0; output < score_.cols; ++output) {
    scores.matrix().col(output) = saved.hidden.matrix()
                                      .middleCols(output * width_, width_)
                                      .lazyProduct(score_.In(parameters).matrix().col(output));
    scores.matrix().col(output).array() += score_bias_.In(parameters).data[output];
  }
  return scores;
}

template <typename Scalar>
void PointerDecoder<Scalar>::JoinState(Arena<Scalar>& arena, const Input& input,
                                       View<const Scalar> context, Saved& saved) const {
  const Index memory = input.memory.cols;
  saved.joined = arena.Take(1, 2 * width_ + memory + input.globals.cols);
  auto row = saved.joined.matrix().row(0);
  row.head(width_) = input.nodes.matrix().row(input.current);
  row.segment(width_, width_) = context.matrix().row(0);
  if (memory > 0) row.segment(2 * width_, memory) = input.memory.matrix().row(0);
  if (input.globals.cols > 0) row.tail(input.globals.cols) = input.globals.matrix().row(0);
}

template <typename Scalar>
void PointerDecoder<Scalar>::JoinPointer(Arena<Scalar>& arena, const Input& input,
                                         Saved& saved) const {
  saved.pointer_input = arena.Take(input.action_count, 2 * width_ + kEdgeFeatures);
  for (Index a = 0; a < input.action_count; ++a) {
    auto row = saved.pointer_input.matrix().row(a);
    row.head(width_) = saved.state.matrix().row(0);
    row.segment(width_, width_) = input.nodes.matrix().row(input.actions[a]);
    row.tail(kEdgeFeatures) = input.to_all.matrix().row(input.actions[a]);
  }
}

template <typename Scalar>
View<Scalar> PointerDecoder<Scalar>::HiddenBackward(const Backprop<Scalar>& pass,
                                                    const Saved& saved,
                                                    View<const Scalar> d_scores) const {
  const View<Scalar> d_hidden = pass.arena.Take(saved.hidden.rows, saved.hidden.cols);
  for (Index output = 0; output < score_.cols; ++output) {
    const auto d_score = d_scores.matrix().col(output);
    const auto hidden = saved.hidden.matrix().middleCols(output * width_, width_);
    score_.In(pass.gradient).matrix().col(output) += hidden.transpose().lazyProduct(d_score);
    score_bias_.In(pass.gradient).data[output] += d_score.sum();
    d_hidden.matrix().middleCols(output * width_, width_) =
        d_score.lazyProduct(score_.In(pass.parameters).matrix().col(output).transpose());
  }
  ReluBackward<Scalar>(saved.hidden, d_hidden);
  return d_hidden;
}

template <typename Scalar>
void PointerDecoder<Scalar>::Backward(const Backprop<Scalar>& pass, const Saved& saved,
                                      View<const Scalar> d_scores, View<Scalar> d_nodes,
                                      View<Scalar> d_memory) const {
  const typename Arena<Scalar>::Scope scope(pass.arena);
  const Input& input = saved.input;
  const View<Scalar> d_hidden = HiddenBackward(pass, saved, d_scores);
  const View<Scalar> d_pointer =
      pass.arena.TakeZero(saved.pointer_input.rows, saved.pointer_input.cols);
  pointer_.Backward(pass, saved.pointer_input, d_hidden, d_pointer);
  for (Index a = 0; a < input.action_count; ++a) {
    d_nodes.matrix().row(input.actions[a]) += d_pointer.matrix().row(a).segment(width_, width_);
  }
  const View<Scalar> d_state = pass.arena.Take(1, width_);
  d_state.matrix() = d_pointer.matrix().leftCols(width_).colwise().sum();
  ReluBackward<Scalar>(saved.state, d_state);
  const View<Scalar> d_joined = pass.arena.TakeZero(1, saved.joined.cols);
  state_.Backward(pass, saved.joined, d_state, d_joined);
  const View<Scalar> d_current(d_nodes.row(input.current), 1, width_);
  d_current.matrix() += d_joined.matrix().leftCols(width_);
  if (d_memory.cols > 0) {
    d_memory.matrix() += d_joined.matrix().middleCols(2 * width_, d_memory.cols);
  }
  const View<Scalar> d_context(d_joined.data + width_, 1, width_);
  attention_.Backward(pass, saved.attention, d_context, d_current, d_nodes);
}

template class PointerDecoder<float>;
template class PointerDecoder<double>;

}  // namespace hv::explore::nn
