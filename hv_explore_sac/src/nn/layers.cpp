#include "hv_explore_sac/nn/layers.h"

#include <cmath>

#include "hv_explore_sac/nn/kernels.h"

namespace hv::explore::nn {

template <typename Scalar>
Linear<Scalar>::Linear(ParameterLayout& layout, const std::string& name, Index inputs,
                       Index outputs, Init init)
    : weight_(layout.Add(name + ".weight", inputs, outputs, init)),
      bias_(layout.Add(name + ".bias", 1, outputs, Init::kZero)) {}

template <typename Scalar>
void Linear<Scalar>::Forward(const Scalar* parameters, View<const Scalar> x, View<Scalar> y) const {
  y.matrix().rowwise() = bias_.In(parameters).matrix().row(0);
  AddProduct<Scalar>(x, weight_.In(parameters), y);
}

template <typename Scalar>
void Linear<Scalar>::Backward(const Backprop<Scalar>& pass, View<const Scalar> x,
                              View<const Scalar> d_y, View<Scalar> d_x) const {
  AddTransposedProduct<Scalar>(x, d_y, weight_.In(pass.gradient));
  bias_.In(pass.gradient).matrix() += d_y.matrix().colwise().sum();
  if (d_x.data == nullptr) return;
  const typename Arena<Scalar>::Scope scope(pass.arena);
  const View<Scalar> transposed = pass.arena.Take(weight_.cols, weight_.rows);
  transposed.matrix() = weight_.In(pass.parameters).matrix().transpose();
  AddProduct<Scalar>(d_y, transposed, d_x);
}

template <typename Scalar>
LayerNorm<Scalar>::LayerNorm(ParameterLayout& layout, const std::string& name, Index width)
    : gain_(layout.Add(name + ".gain", 1, width, Init::kOne)),
      shift_(layout.Add(name + ".shift", 1, width, Init::kZero)) {}

template <typename Scalar>
View<Scalar> LayerNorm<Scalar>::Forward(const Scalar* parameters, Arena<Scalar>& arena,
                                        View<const Scalar> x, Saved& saved) const {
  constexpr Scalar kSmallestVariance = Scalar(1e-5);
  saved.normal = arena.Take(x.rows, x.cols);
  saved.inverse_deviation = arena.Take(x.rows, 1);
  const View<Scalar> y = arena.Take(x.rows, x.cols);
  const auto gain = gain_.In(parameters).matrix().row(0);
  const auto shift = shift_.In(parameters).matrix().row(0);
  for (Index i = 0; i < x.rows; ++i) {
    auto normal = saved.normal.matrix().row(i);
    normal = x.matrix().row(i).array() - x.matrix().row(i).mean();
    const Scalar variance = normal.squaredNorm() / static_cast<Scalar>(x.cols);
    const Scalar inverse = 1 / std::sqrt(variance + kSmallestVariance);
    saved.inverse_deviation.data[i] = inverse;
    normal *= inverse;
    y.matrix().row(i) = normal.cwiseProduct(gain) + shift;
  }
  return y;
}

template <typename Scalar>
void LayerNorm<Scalar>::Backward(const Backprop<Scalar>& pass, const Saved& saved,
                                 View<const Scalar> d_y, View<Scalar> d_x) const {
  const auto gain = gain_.In(pass.parameters).matrix().row(0);
  auto d_gain = gain_.In(pass.gradient).matrix().row(0);
  auto d_shift = shift_.In(pass.gradient).matrix().row(0);
  const typename Arena<Scalar>::Scope scope(pass.arena);
  auto d_normal = pass.arena.Take(1, d_y.cols).matrix().row(0);
  for (Index i = 0; i < d_y.rows; ++i) {
    const auto normal = saved.normal.matrix().row(i);
    const auto d_row = d_y.matrix().row(i);
    d_gain += d_row.cwiseProduct(normal);
    d_shift += d_row;
    d_normal = d_row.cwiseProduct(gain);
    const Scalar along = d_normal.dot(normal) / static_cast<Scalar>(d_y.cols);
    d_x.matrix().row(i).array() += saved.inverse_deviation.data[i] *
                                   (d_normal.array() - d_normal.mean() - along * normal.array());
  }
}

template <typename Scalar>
FeedForward<Scalar>::FeedForward(ParameterLayout& layout, const std::string& name, Index width,
                                 Index hidden)
    : expand_(layout, name + ".expand", width, hidden),
      contract_(layout, name + ".contract", hidden, width) {}

template <typename Scalar>
View<Scalar> FeedForward<Scalar>::Forward(const Scalar* parameters, Arena<Scalar>& arena,
                                          View<const Scalar> x, Saved& saved) const {
  saved.x = x;
  saved.hidden = arena.Take(x.rows, expand_.outputs());
  expand_.Forward(parameters, x, saved.hidden);
  Relu(saved.hidden);
  const View<Scalar> y = arena.Take(x.rows, contract_.outputs());
  contract_.Forward(parameters, saved.hidden, y);
  return y;
}

template <typename Scalar>
void FeedForward<Scalar>::Backward(const Backprop<Scalar>& pass, const Saved& saved,
                                   View<const Scalar> d_y, View<Scalar> d_x) const {
  const typename Arena<Scalar>::Scope scope(pass.arena);
  const View<Scalar> d_hidden = pass.arena.TakeZero(saved.hidden.rows, saved.hidden.cols);
  contract_.Backward(pass, saved.hidden, d_y, d_hidden);
  ReluBackward<Scalar>(saved.hidden, d_hidden);
  expand_.Backward(pass, saved.x, d_hidden, d_x);
}

template class Linear<float>;
template class Linear<double>;
template class LayerNorm<float>;
template class LayerNorm<double>;
template class FeedForward<float>;
template class FeedForward<double>;

}  // namespace hv::explore::nn
