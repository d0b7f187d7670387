#pragma once

#include <cstddef>

namespace hv::explore {

/// The processes that train together. By itself: this one alone. All ranks make the same calls in
/// the same order.
class Ranks {
 public:
  virtual ~Ranks() = default;
  virtual int rank() const { return 0; }
  virtual int size() const { return 1; }
  /// Replaces each number by its sum over all ranks, the same bits on each.
  virtual void Sum(float* numbers, std::size_t count) {
    static_cast<void>(numbers);
    static_cast<void>(count);
  }
};

}  // namespace hv::explore
