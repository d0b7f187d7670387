#include "hv_core/recent_durations.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hv {

RecentDurations::RecentDurations(std::size_t kept) : kept_(std::max<std::size_t>(kept, 1)) {
  durations_ms_.reserve(kept_);
}

void RecentDurations::Add(double duration_ms) {
  longest_ms_ = std::max(longest_ms_, duration_ms);
  if (durations_ms_.size() < kept_) {
    durations_ms_.push_back(duration_ms);
    return;
  }
  durations_ms_[next_] = duration_ms;
  next_ = (next_ + 1) % kept_;
}

double RecentDurations::Quantile_ms(double share) const {
  if (durations_ms_.empty()) return 0.0;
  const double count = static_cast<double>(durations_ms_.size());
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(std::clamp(share, 0.0, 1.0) * count));
  std::vector<double> sorted = durations_ms_;
  const auto at = sorted.begin() + std::max<std::ptrdiff_t>(rank - 1, 0);
  std::nth_element(sorted.begin(), at, sorted.end());
  return *at;
}

double RecentDurations::Mean_ms() const {
  if (durations_ms_.empty()) return 0.0;
  return std::accumulate(durations_ms_.begin(), durations_ms_.end(), 0.0) /
         static_cast<double>(durations_ms_.size());
}

}  // namespace hv
