#include "hv_explore_sac/nn/node_pyramid.h"

namespace hv::explore::nn {
namespace {

/// to_i += from_{parent of i}
template <typename Scalar>
void AddOfParents(const std::int32_t* parent, View<const Scalar> from, View<Scalar> to) {
  for (Index i = 0; i < to.rows; ++i) to.matrix().row(i) += from.matrix().row(parent[i]);
}

/// to_{parent of i} += from_i
template <typename Scalar>
void AddToParents(const std::int32_t* parent, View<const Scalar> from, View<Scalar> to) {
  for (Index i = 0; i < from.rows; ++i) to.matrix().row(parent[i]) += from.matrix().row(i);
}

/// Divides each row by the number of members of its cluster.
template <typename Scalar>
void DivideByMembers(Arena<Scalar>& arena, const std::int32_t* parent, Index nodes,
                     View<Scalar> x) {
  const typename Arena<Scalar>::Scope scope(arena);
  const View<Scalar> members = arena.TakeZero(x.rows, 1);
  for (Index i = 0; i < nodes; ++i) members.data[parent[i]] += 1;
  for (Index c = 0; c < x.rows; ++c) x.matrix().row(c) /= members.data[c];
}

}  // namespace

template <typename Scalar>
NodePyramid<Scalar>::NodePyramid(ParameterLayout& layout, const std::string& name, Index width,
                                 Index heads, Index hidden, int coarser_levels) {
  for (int level = 0; level < coarser_levels; ++level) {
    const std::string at = name + std::to_string(level);
    layers_.emplace_back(layout, at + ".layer", width, heads, hidden);
    laterals_.emplace_back(layout, at + ".lateral", width, width);
    tops_.emplace_back(layout, at + ".top", width, width);
  }
}

template <typename Scalar>
View<Scalar> NodePyramid<Scalar>::Forward(const Scalar* parameters, Arena<Scalar>& arena,
                                          const std::vector<LevelView<Scalar>>& levels,
                                          View<Scalar> x, Saved& saved) const {
  saved.scales.resize(layers_.size() + 1);
  saved.scales[0].x = x;
  for (std::size_t l = 0; l < layers_.size(); ++l) {
    const LevelView<Scalar>& coarse = levels[l + 1];
    Scale& scale = saved.scales[l + 1];
    scale.x = Pool(arena, levels[l], saved.scales[l].x, coarse.lists.rows);
    layers_[l].Forward(parameters, arena, coarse.lists, coarse.edges, scale.x, scale.layer);
  }
  saved.scales.back().fused = saved.scales.back().x;
  for (std::size_t l = layers_.size(); l-- > 0;) Fuse(parameters, arena, levels[l], l, saved);
  return saved.scales[0].fused;
}

template <typename Scalar>
View<Scalar> NodePyramid<Scalar>::Pool(Arena<Scalar>& arena, const LevelView<Scalar>& fine,
                                       View<const Scalar> x, Index clusters) const {
  const View<Scalar> pooled = arena.TakeZero(clusters, x.cols);
  AddToParents<Scalar>(fine.parent, x, pooled);
  DivideByMembers(arena, fine.parent, x.rows, pooled);
  return pooled;
}

template <typename Scalar>
void NodePyramid<Scalar>::Fuse(const Scalar* parameters, Arena<Scalar>& arena,
                               const LevelView<Scalar>& fine, std::size_t level,
                               Saved& saved) const {
  Scale& scale = saved.scales[level];
  const View<const Scalar> coarse = saved.scales[level + 1].fused;
  scale.fused = arena.Take(scale.x.rows, scale.x.cols);
  scale.detail = arena.Take(scale.x.rows, scale.x.cols);
  const typename Arena<Scalar>::Scope scope(arena);
  const View<Scalar> top = arena.Take(coarse.rows, coarse.cols);
  tops_[level].Forward(parameters, coarse, top);
  laterals_[level].Forward(parameters, scale.x, scale.detail);
  AddOfParents<Scalar>(fine.parent, top, scale.detail);
  Relu(scale.detail);
  scale.fused.matrix() = scale.x.matrix() + scale.detail.matrix();
}

template <typename Scalar>
void NodePyramid<Scalar>::FuseBackward(const Backprop<Scalar>& pass, const LevelView<Scalar>& fine,
                                       std::size_t level, const Saved& saved, View<Scalar> d_fine,
                                       View<Scalar> d_coarse) const {
  const typename Arena<Scalar>::Scope scope(pass.arena);
  const Scale& scale = saved.scales[level];
  const View<Scalar> d_detail = pass.arena.Take(d_fine.rows, d_fine.cols);
  d_detail.matrix() = d_fine.matrix();
  ReluBackward<Scalar>(scale.detail, d_detail);
  laterals_[level].Backward(pass, scale.x, d_detail, d_fine);
  const View<Scalar> d_top = pass.arena.TakeZero(d_coarse.rows, d_coarse.cols);
  AddToParents<Scalar>(fine.parent, d_detail, d_top);
  tops_[level].Backward(pass, saved.scales[level + 1].fused, d_top, d_coarse);
}

template <typename Scalar>
void NodePyramid<Scalar>::Backward(const Backprop<Scalar>& pass,
                                   const std::vector<LevelView<Scalar>>& levels, const Saved& saved,
                                   View<Scalar> d_x) const {
  constexpr std::size_t kMostLevels = 8;
  View<Scalar> d[kMostLevels + 1];
  const typename Arena<Scalar>::Scope scope(pass.arena);
  d[0] = d_x;
  for (std::size_t l = 0; l < layers_.size(); ++l) {
    const Scale& coarse = saved.scales[l + 1];
    d[l + 1] = pass.arena.TakeZero(coarse.x.rows, coarse.x.cols);
    FuseBackward(pass, levels[l], l, saved, d[l], d[l + 1]);
  }
  for (std::size_t l = layers_.size(); l-- > 0;) {
    layers_[l].Backward(pass, saved.scales[l + 1].layer, d[l + 1]);
    DivideByMembers(pass.arena, levels[l].parent, d[l].rows, d[l + 1]);
    AddOfParents<Scalar>(levels[l].parent, d[l + 1], d[l]);
  }
}

template class NodePyramid<float>;
template class NodePyramid<double>;

}  // namespace hv::explore::nn
