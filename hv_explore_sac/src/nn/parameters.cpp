#include "hv_explore_sac/nn/parameters.h"

#include <cmath>
#include <random>

namespace hv::explore::nn {

Slot ParameterLayout::Add(const std::string& name, Index rows, Index cols, Init init) {
  const Slot slot{size_, rows, cols};
  blocks_.push_back({name, slot, init});
  size_ += rows * cols;
  return slot;
}

Eigen::VectorXf ParameterLayout::Initial(std::uint64_t seed) const {
  Eigen::VectorXf flat = Eigen::VectorXf::Zero(size_);
  std::mt19937_64 random(seed);
  for (const Block& block : blocks_) {
    const Slot& slot = block.slot;
    auto values = flat.segment(slot.offset, slot.rows * slot.cols);
    if (block.init == Init::kOne) values.setOnes();
    if (block.init == Init::kZero || block.init == Init::kOne) continue;
    const double glorot = std::sqrt(6.0 / static_cast<double>(slot.rows + slot.cols));
    const double bound = block.init == Init::kSmall ? 0.01 * glorot : glorot;
    for (float& value : values) {
      const double unit = static_cast<double>(random() >> 11U) * 0x1p-53;
      value = static_cast<float>(bound * (2.0 * unit - 1.0));
    }
  }
  return flat;
}

}  // namespace hv::explore::nn
