#include "hv_explore_sac/nn/kernels.h"

#include <cassert>
#include <cmath>

#include "kernel_table.h"

namespace hv::explore::nn {
namespace {

bool HasFma() {
#ifdef HV_FMA_KERNELS
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

template <typename Scalar>
const KernelTable<Scalar>& Kernels() {
#ifdef HV_FMA_KERNELS
  static const KernelTable<Scalar> table = HasFma() ? FmaKernels<Scalar>() : PlainKernels<Scalar>();
#else
  static const KernelTable<Scalar> table = PlainKernels<Scalar>();
#endif
  return table;
}

template <typename Scalar>
AttentionTask<Scalar> TaskOf(const AttentionInput<Scalar>& input) {
  const NeighbourLists& lists = input.lists;
  assert(input.q.rows == lists.rows && input.kv.cols == 2 * input.q.cols);
  const Index depth = input.q.cols / input.heads;
  const Scalar scale = 1 / std::sqrt(static_cast<Scalar>(depth));
  return {lists.rows, lists.start, lists.neighbour, input.heads,
          depth,      scale,       input.q.data,    input.kv.data};
}

}  // namespace

template <typename Scalar>
void AddProduct(View<const Scalar> a, View<const Scalar> b, View<Scalar> c) {
  assert(a.cols == b.rows && a.rows == c.rows && b.cols == c.cols);
  Kernels<Scalar>().add_product({a.data, a.cols, 1, b.data, c.data, c.rows, a.cols, c.cols});
}

template <typename Scalar>
void AddTransposedProduct(View<const Scalar> a, View<const Scalar> b, View<Scalar> c) {
  assert(a.rows == b.rows && a.cols == c.rows && b.cols == c.cols);
  Kernels<Scalar>().add_product({a.data, 1, a.cols, b.data, c.data, c.rows, a.rows, c.cols});
}

template <typename Scalar>
void AttentionWeights(const AttentionInput<Scalar>& input, View<Scalar> scores) {
  const AttentionTask<Scalar> task = TaskOf(input);
  Kernels<Scalar>().attention_scores(task, scores.data);
  Kernels<Scalar>().softmax(task, scores.data);
}

template <typename Scalar>
void MixValues(const AttentionInput<Scalar>& input, View<const Scalar> weights, View<Scalar> out) {
  Kernels<Scalar>().mix_values(TaskOf(input), weights.data, out.data);
}

template <typename Scalar>
void AttentionBackward(const AttentionInput<Scalar>& input, View<const Scalar> out,
                       View<const Scalar> d_out, View<Scalar> weights,
                       const QueryMemory<Scalar>& gradient) {
  Kernels<Scalar>().attention_backward(
      TaskOf(input), {out.data, d_out.data, weights.data, gradient.q.data, gradient.kv.data});
}

const char* KernelSet() { return HasFma() ? "avx2+fma" : "plain"; }

#define HV_INSTANTIATE(Scalar)                                                              \
  template void AddProduct(View<const Scalar>, View<const Scalar>, View<Scalar>);           \
  template void AddTransposedProduct(View<const Scalar>, View<const Scalar>, View<Scalar>); \
  template void AttentionWeights(const AttentionInput<Scalar>&, View<Scalar>);              \
  template void MixValues(const AttentionInput<Scalar>&, View<const Scalar>, View<Scalar>); \
  template void AttentionBackward(const AttentionInput<Scalar>&, View<const Scalar>,        \
                                  View<const Scalar>, View<Scalar>, const QueryMemory<Scalar>&);
HV_INSTANTIATE(float)
HV_INSTANTIATE(double)
#undef HV_INSTANTIATE

}  // namespace hv::explore::nn
