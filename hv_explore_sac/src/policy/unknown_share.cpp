#include "hv_explore_sac/policy/unknown_share.h"

#include <algorithm>
#include <cmath>

namespace hv::explore {

void UnknownShare::Count(const Frontiers& frontiers, int edge) {
  square_ = edge * frontiers.block();
  columns_ = (frontiers.columns() + edge - 1) / edge;
  rows_ = (frontiers.rows() + edge - 1) / edge;
  const auto stride = static_cast<std::size_t>(columns_) + 1;
  sums_.assign(stride * (static_cast<std::size_t>(rows_) + 1), 0);
  for (int y = 0; y < frontiers.rows(); ++y) {
    int* const row = &sums_[stride * static_cast<std::size_t>(y / edge + 1) + 1];
    const int end = (y + 1) * frontiers.columns();
    int block = y * frontiers.columns();
    for (int column = 0; column < columns_; ++column) {
      for (const int next = std::min(block + edge, end); block < next; ++block) {
        row[column] += frontiers.UnknownIn(block);
      }
    }
  }
  for (std::size_t i = stride; i < sums_.size(); ++i) {
    if (i % stride == 0) continue;
    sums_[i] += sums_[i - 1] + sums_[i - stride] - sums_[i - stride - 1];
  }
}

float UnknownShare::Around(const Eigen::Vector2f& cell, float reach) const {
  const auto block = [this](float place, int most) {
    return std::clamp(static_cast<int>(std::lround(place / static_cast<float>(square_))), 0, most);
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
  return static_cast<float>(sums_.back()) /
         static_cast<float>(columns_ * rows_ * square_ * square_);
}

}  // namespace hv::explore
