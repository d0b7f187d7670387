#include <cstring>

#include "kernel_table.h"

namespace hv::explore::nn {
namespace {
#include "product_loops.h"
// The tile of a product comes first.
#include "attention_loops.h"
}  // namespace

template <typename Scalar>
KernelTable<Scalar> FmaKernels() {
  return {AddProductLoop<Scalar>, ScoresLoop<Scalar>, SoftmaxLoop<Scalar>, MixLoop<Scalar>,
          BackwardLoop<Scalar>};
}

template KernelTable<float> FmaKernels();
template KernelTable<double> FmaKernels();

}  // namespace hv::explore::nn
