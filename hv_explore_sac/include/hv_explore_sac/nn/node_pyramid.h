#pragma once

#include <string>
#include <vector>

#include "hv_explore_sac/nn/attention.h"

namespace hv::explore::nn {

/// One scale as the layers read it.
template <typename Scalar>
struct LevelView {
  NeighbourLists lists;
  View<const Scalar> edges;
  /// Null in the coarsest level.
  const std::int32_t* parent = nullptr;
};

/// Node Pyramid Network (paper, section 3.3.4): a feature pyramid over coarser and coarser views
/// of the graph.
///
///   upwards:    x_{l+1} = layer_l(mean of x_l over each cluster)
///   downwards:  f_top = x_top,   f_l = x_l + relu(lateral_l(x_l) + top_l(f_{l+1} of the parent))
///
/// A node so learns of places that six steps along edges cannot reach. The clusters are those of
/// Coarsen().
template <typename Scalar>
class NodePyramid {
 public:
  struct Scale {
    View<Scalar> x;
    View<Scalar> fused;
    /// relu(...) of the way down.
    View<Scalar> detail;
    typename EncoderLayer<Scalar>::Saved layer;
  };
  struct Saved {
    std::vector<Scale> scales;
  };

  NodePyramid(ParameterLayout& layout, const std::string& name, Index width, Index heads,
              Index hidden, int coarser_levels);

  /// `levels` holds one more than the pyramid has coarser ones. Gives the fused features of the
  /// finest level; without coarser levels, `x` itself.
  View<Scalar> Forward(const Scalar* parameters, Arena<Scalar>& arena,
                       const std::vector<LevelView<Scalar>>& levels, View<Scalar> x,
                       Saved& saved) const;
  /// Turns the gradient of the outcome into that of the input, in place.
  void Backward(const Backprop<Scalar>& pass, const std::vector<LevelView<Scalar>>& levels,
                const Saved& saved, View<Scalar> d_x) const;

 private:
  View<Scalar> Pool(Arena<Scalar>& arena, const LevelView<Scalar>& fine, View<const Scalar> x,
                    Index clusters) const;
  void Fuse(const Scalar* parameters, Arena<Scalar>& arena, const LevelView<Scalar>& fine,
            std::size_t level, Saved& saved) const;
  void FuseBackward(const Backprop<Scalar>& pass, const LevelView<Scalar>& fine, std::size_t level,
                    const Saved& saved, View<Scalar> d_fine, View<Scalar> d_coarse) const;

  std::vector<EncoderLayer<Scalar>> layers_;
  std::vector<Linear<Scalar>> laterals_;
  std::vector<Linear<Scalar>> tops_;
};

extern template class NodePyramid<float>;
extern template class NodePyramid<double>;

}  // namespace hv::explore::nn
