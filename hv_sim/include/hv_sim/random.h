#pragma once

#include <cstdint>
#include <initializer_list>

namespace hv::sim {

/// Small random generator (SplitMix64) whose sequence depends only on its keys, on every platform.
/// Cheap to construct, so each place or firing column can have its own.
class Random {
 public:
  explicit Random(std::initializer_list<std::uint64_t> keys);

  std::uint64_t Bits();
  double Uniform(double low = 0.0, double high = 1.0);  ///< in [low, high)
  bool Chance(double probability) { return Uniform() < probability; }
  double Gauss();  ///< standard normal

 private:
  std::uint64_t state_ = 0;
};

}  // namespace hv::sim
