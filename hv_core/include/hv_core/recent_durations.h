#pragma once

#include <cstddef>
#include <vector>

namespace hv {

/// How long the newest events took, in constant memory. Not thread-safe.
class RecentDurations {
 public:
  /// The `kept` newest are kept, at least one.
  explicit RecentDurations(std::size_t kept);

  void Add(double duration_ms);

  /// Of those kept: the shortest that at least `share` (0 to 1) of them do not exceed [ms]; 0
  /// before the first.
  double Quantile_ms(double share) const;
  /// Of those kept [ms]; 0 before the first.
  double Mean_ms() const;
  /// Of all ever added [ms].
  double longest_ms() const { return longest_ms_; }

 private:
  std::size_t kept_;
  std::vector<double> durations_ms_;  // a ring once it is full
  std::size_t next_ = 0;
  double longest_ms_ = 0.0;
};

}  // namespace hv
