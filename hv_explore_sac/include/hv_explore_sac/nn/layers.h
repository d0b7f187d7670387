#pragma once

#include <string>

#include "hv_explore_sac/nn/parameters.h"

/// The elementary layers. Each owns only the places of its parameters; parameters, activations and
/// gradients belong to the caller. Forward leaves what backward needs in a `Saved`; backward adds
/// to the gradient of the parameters and to that of the input. Thread-safe: layers are constant.

namespace hv::explore::nn {

/// What a backward pass reads and writes beside activations.
template <typename Scalar>
struct Backprop {
  const Scalar* parameters;
  /// Of the parameters, laid out as they are; added to.
  Scalar* gradient;
  Arena<Scalar>& arena;
};

/// y = x W + b, one row per node.
template <typename Scalar>
class Linear {
 public:
  Linear() = default;
  Linear(ParameterLayout& layout, const std::string& name, Index inputs, Index outputs,
         Init init = Init::kGlorot);

  void Forward(const Scalar* parameters, View<const Scalar> x, View<Scalar> y) const;
  /// `d_x` may be empty where nobody asks for the gradient of the input.
  void Backward(const Backprop<Scalar>& pass, View<const Scalar> x, View<const Scalar> d_y,
                View<Scalar> d_x) const;
  Index outputs() const { return weight_.cols; }

 private:
  Slot weight_;
  Slot bias_;
};

/// y = gain (x - mean) / deviation + shift, over the columns of each row.
template <typename Scalar>
class LayerNorm {
 public:
  struct Saved {
    View<Scalar> normal;
    View<Scalar> inverse_deviation;
  };

  LayerNorm() = default;
  LayerNorm(ParameterLayout& layout, const std::string& name, Index width);

  View<Scalar> Forward(const Scalar* parameters, Arena<Scalar>& arena, View<const Scalar> x,
                       Saved& saved) const;
  void Backward(const Backprop<Scalar>& pass, const Saved& saved, View<const Scalar> d_y,
                View<Scalar> d_x) const;

 private:
  Slot gain_;
  Slot shift_;
};

/// relu(x A + a) B + b for each node by itself.
template <typename Scalar>
class FeedForward {
 public:
  struct Saved {
    View<const Scalar> x;
    View<Scalar> hidden;
  };

  FeedForward() = default;
  FeedForward(ParameterLayout& layout, const std::string& name, Index width, Index hidden);

  View<Scalar> Forward(const Scalar* parameters, Arena<Scalar>& arena, View<const Scalar> x,
                       Saved& saved) const;
  void Backward(const Backprop<Scalar>& pass, const Saved& saved, View<const Scalar> d_y,
                View<Scalar> d_x) const;

 private:
  Linear<Scalar> expand_;
  Linear<Scalar> contract_;
};

/// x = max(x, 0), and its backward: what the outcome stopped gets no gradient.
template <typename Scalar>
void Relu(View<Scalar> x) {
  x.matrix() = x.matrix().cwiseMax(Scalar(0));
}
template <typename Scalar>
void ReluBackward(View<const Scalar> y, View<Scalar> d_y) {
  for (Index i = 0; i < y.size(); ++i)
    d_y.data[i] = y.data[i] > Scalar(0) ? d_y.data[i] : Scalar(0);
}

extern template class Linear<float>;
extern template class Linear<double>;
extern template class LayerNorm<float>;
extern template class LayerNorm<double>;
extern template class FeedForward<float>;
extern template class FeedForward<double>;

}  // namespace hv::explore::nn
