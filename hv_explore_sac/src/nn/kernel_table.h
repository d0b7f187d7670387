#pragma once

#include <cstddef>
#include <cstdint>

/// What the two compilations of the inner loops share. Plain memory and no other header: a unit
/// that is compiled for newer processors must not leave its copy of anybody's inline function to
/// the rest of the program.

namespace hv::explore::nn {

/// c += a b with a(i, p) at a[i * a_row + p * a_depth], so that a transposed one fits as well.
template <typename Scalar>
struct ProductTask {
  const Scalar* a;
  std::ptrdiff_t a_row;
  std::ptrdiff_t a_depth;
  const Scalar* b;
  Scalar* c;
  std::ptrdiff_t rows;
  std::ptrdiff_t depth;
  std::ptrdiff_t cols;
};

/// Attention of `rows` queries over neighbour lists; see kernels.h.
template <typename Scalar>
struct AttentionTask {
  std::ptrdiff_t rows;
  const std::int32_t* start;
  const std::int32_t* neighbour;
  std::ptrdiff_t heads;
  /// Columns of one head.
  std::ptrdiff_t depth;
  Scalar scale;
  const Scalar* q;
  const Scalar* kv;
};

/// `weights` become the gradient of the scores; `d_q` and `d_kv` are added to.
template <typename Scalar>
struct AttentionGradient {
  const Scalar* out;
  const Scalar* d_out;
  Scalar* weights;
  Scalar* d_q;
  Scalar* d_kv;
};

template <typename Scalar>
struct KernelTable {
  void (*add_product)(const ProductTask<Scalar>& task);
  void (*attention_scores)(const AttentionTask<Scalar>& task, Scalar* scores);
  void (*softmax)(const AttentionTask<Scalar>& task, Scalar* scores);
  void (*mix_values)(const AttentionTask<Scalar>& task, const Scalar* weights, Scalar* out);
  void (*attention_backward)(const AttentionTask<Scalar>& task,
                             const AttentionGradient<Scalar>& gradient);
};

template <typename Scalar>
KernelTable<Scalar> PlainKernels();
/// Only for processors with AVX and FMA.
template <typename Scalar>
KernelTable<Scalar> FmaKernels();

}  // namespace hv::explore::nn
