#pragma once

#include <string>

#include "hv_explore_sac/nn/attention.h"

namespace hv::explore::nn {

/// Pointer decoder (paper, section 3.3.4): scores of the neighbours to which the robot may go.
///
///   context = attention of the current node over all nodes
///   state   = relu(S [current, context, memory, globals])
///   score   = v^T relu(P [state, neighbour, edge])
///
/// The form is the additive pointer of Vinyals et al. (2015). An actor has one output, its
/// logarithmic preferences; twin critics are two outputs with their own P and v, the action values.
template <typename Scalar>
class PointerDecoder {
 public:
  struct Input {
    View<const Scalar> nodes;
    Index current = 0;
    const std::int32_t* actions = nullptr;
    Index action_count = 0;
    /// Edge features from the current node to every node.
    View<const Scalar> to_all;
    /// 0 .. nodes, the list of the one query.
    NeighbourLists all;
    View<const Scalar> memory;
    View<const Scalar> globals;
  };
  struct Saved {
    Input input;
    typename NeighbourAttention<Scalar>::Saved attention;
    View<Scalar> joined;
    View<Scalar> state;
    View<Scalar> pointer_input;
    View<Scalar> hidden;
  };

  PointerDecoder(ParameterLayout& layout, const std::string& name, Index width, Index heads,
                 Index memory, Index globals, Index outputs);

  /// [actions x outputs]
  View<Scalar> Forward(const Scalar* parameters, Arena<Scalar>& arena, const Input& input,
                       Saved& saved) const;
  /// Adds to the gradients of nodes and memory.
  void Backward(const Backprop<Scalar>& pass, const Saved& saved, View<const Scalar> d_scores,
                View<Scalar> d_nodes, View<Scalar> d_memory) const;

 private:
  void JoinState(Arena<Scalar>& arena, const Input& input, View<const Scalar> context,
                 Saved& saved) const;
  void JoinPointer(Arena<Scalar>& arena, const Input& input, Saved& saved) const;
  View<Scalar> HiddenBackward(const Backprop<Scalar>& pass, const Saved& saved,
                              View<const Scalar> d_scores) const;

  Index width_;
  NeighbourAttention<Scalar> attention_;
  Linear<Scalar> state_;
  Linear<Scalar> pointer_;
  /// [width x outputs]
  Slot score_;
  Slot score_bias_;
};

extern template class PointerDecoder<float>;
extern template class PointerDecoder<double>;

}  // namespace hv::explore::nn
