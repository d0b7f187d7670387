#pragma once

#include <string>

#include "hv_explore_sac/nn/layers.h"

namespace hv::explore::nn {

/// Long short-term memory over the nodes visited last (paper, section 3.3.4). It is run anew from
/// a state of zeros over the window of each sample, so back-propagation through time is exact and
/// truncated at that window, and the replay buffer need not keep hidden states that grow stale.
/// Gates in the order input, forget, cell, output.
template <typename Scalar>
class Lstm {
 public:
  struct Saved {
    View<const Scalar> x;
    /// [steps x 4 width] after their non-linearities.
    View<Scalar> gates;
    /// [steps + 1 x width], the first row is the state of zeros.
    View<Scalar> cell;
    View<Scalar> hidden;
  };

  Lstm() = default;
  Lstm(ParameterLayout& layout, const std::string& name, Index inputs, Index width);

  /// The hidden state after the last row of `x`, oldest first; zeros without rows.
  View<Scalar> Forward(const Scalar* parameters, Arena<Scalar>& arena, View<const Scalar> x,
                       Saved& saved) const;
  void Backward(const Backprop<Scalar>& pass, const Saved& saved, View<const Scalar> d_last) const;
  Index width() const { return recurrent_.rows; }

 private:
  Linear<Scalar> input_;
  Slot recurrent_;
};

extern template class Lstm<float>;
extern template class Lstm<double>;

}  // namespace hv::explore::nn
