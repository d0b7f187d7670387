#pragma once

#include <cstdint>

#include "hv_explore_sac/nn/tensor.h"

/// The inner loops in which nearly all time is spent. Eigen fixes its instruction set when it is
/// compiled, and the project is compiled for any x86-64; these loops are compiled twice, for any
/// processor and for those with AVX2 and fused multiply-add, and the faster one is chosen when the
/// program runs (about three times as fast). The last bits of results differ between the two.
/// Instantiated for float and double.

namespace hv::explore::nn {

/// c += a b, with a [m x k], b [k x n], c [m x n].
template <typename Scalar>
void AddProduct(View<const Scalar> a, View<const Scalar> b, View<Scalar> c);

/// c += a^T b, with a [k x m], b [k x n], c [m x n]: the gradient of a weight matrix.
template <typename Scalar>
void AddTransposedProduct(View<const Scalar> a, View<const Scalar> b, View<Scalar> c);

/// Who attends to whom: query i looks at the memory rows neighbour[start[i] .. start[i + 1]), of
/// which there is at least one.
struct NeighbourLists {
  Index rows = 0;
  const std::int32_t* start = nullptr;
  const std::int32_t* neighbour = nullptr;

  Index edges() const { return start[rows]; }
};

/// What attention reads: `q` [queries x width], `kv` [memory rows x 2 width] with the keys, then
/// the values; a head owns width / heads columns of each.
template <typename Scalar>
struct AttentionInput {
  NeighbourLists lists;
  Index heads;
  View<const Scalar> q;
  View<const Scalar> kv;
};

/// Adds <q_i, k_j> / sqrt(depth of a head) to `scores` [edges x heads], in which the caller left a
/// bias of each edge (i, j), and takes the softmax over the edges of each query and head.
template <typename Scalar>
void AttentionWeights(const AttentionInput<Scalar>& input, View<Scalar> scores);

/// out_i = sum over the edges of query i of weight times v_j, head by head.
template <typename Scalar>
void MixValues(const AttentionInput<Scalar>& input, View<const Scalar> weights, View<Scalar> out);

/// Gradients of what attention reads.
template <typename Scalar>
struct QueryMemory {
  View<Scalar> q;
  View<Scalar> kv;
};

/// Backward of both, given the mixed values `out` and their gradient: adds to `gradient`, and turns
/// `weights` into the gradient of the scores.
template <typename Scalar>
void AttentionBackward(const AttentionInput<Scalar>& input, View<const Scalar> out,
                       View<const Scalar> d_out, View<Scalar> weights,
                       const QueryMemory<Scalar>& gradient);

/// "avx2+fma" or "plain".
const char* KernelSet();

}  // namespace hv::explore::nn
