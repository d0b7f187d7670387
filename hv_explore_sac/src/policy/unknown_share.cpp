#include "hv_explore_sac/policy/unknown_share.h"

#include <algorithm>
#include <cmath>

namespace hv::explore {

void UnknownShare::Count(const Belief& belief, int edge) {
  block_ = edge;
  columns_ = (belief.width() + block_ - 1) / block_;
  rows_ = (belief.height() + block_ - 1) / block_;
  const auto stride = static_cast<std::size_t>(columns_) + 1;
  sums_.assign(stride * (static_cast<std::size_t>(rows_) + 1), 0);
  for (int y = 0; y < belief.height(); ++y) {
    int* const row = &sums_[stride * static_cast<std::size_t>(y / block_ + 1) + 1];
    for (int block = 0; block < columns_; ++block) {
      const int first = y * belief.width() + block * block_;
      const int last = std::min(first + block_, (y + 1) * belief.width());
      int count = 0;
      for (int i = first; i < last; ++i) count += belief.At(i) == Cell::kUnknown ? 1 : 0;
      row[block] += count;
    }
  }
  for (std::size_t i = stride; i < sums_.size(); ++i) {
    if (i % stride == 0) continue;
    sums_[i] += sums_[i - 1] + sums_[i - stride] - sums_[i - stride - 1];
  }
}

float UnknownShare::Around(const Eigen::Vector2f& cell, float reach) const {
  const auto block = [this](float place, int most) {
    return std::clamp(static_cast<int>(std::lround(place / static_cast<float>(block_))), 0, most);
  };
  const int left = block(cell.x() - reach, columns_);
  const int right = block(cell.x() + reach, columns_);
  const int low = block(cell.y() - reach, rows_);
  const int high = block(cell.y() + reach, rows_);
  const int sum =
      SumUpTo(right, high) - SumUpTo(left, high) - SumUpTo(right, low) + SumUpTo(left, low);
  return static_cast<float>(sum) / (4.0F * reach * reach);
}

float UnknownShare::Everywhere() const {
  return static_cast<float>(sums_.back()) / static_cast<float>(columns_ * rows_ * block_ * block_);
}

}  // namespace hv::explore
