#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hv_explore_sac/nn/tensor.h"

namespace hv::explore::nn {

/// How a block of parameters starts.
enum class Init {
  kZero,
  kOne,
  /// Uniform in +-sqrt(6 / (rows + cols)), which keeps the variance of activations (Glorot).
  kGlorot,
  /// A hundredth of that: outputs start near zero, a policy near uniform.
  kSmall,
};

/// One matrix among the parameters, found by where it lies in the flat vector.
struct Slot {
  Index offset = 0;
  Index rows = 0;
  Index cols = 0;

  /// The block within a flat vector of parameters or of their gradient.
  template <typename Scalar>
  View<Scalar> In(Scalar* flat) const {
    return {flat + offset, rows, cols};
  }
};

/// The names, shapes and places of all parameters of a network within one flat vector. The vector
/// itself is kept apart, so that the optimiser, soft updates of targets, checkpoints and sums over
/// ranks are operations on one vector.
class ParameterLayout {
 public:
  struct Block {
    std::string name;
    Slot slot;
    Init init;
  };

  Slot Add(const std::string& name, Index rows, Index cols, Init init);
  Index size() const { return size_; }
  const std::vector<Block>& blocks() const { return blocks_; }

  /// The start of training: depends on the seed, names and shapes alone, on no library's
  /// distributions.
  Eigen::VectorXf Initial(std::uint64_t seed) const;

 private:
  std::vector<Block> blocks_;
  Index size_ = 0;
};

}  // namespace hv::explore::nn
