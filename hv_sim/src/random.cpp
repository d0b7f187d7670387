#include "hv_sim/random.h"

#include <cmath>

namespace hv::sim {

Random::Random(std::initializer_list<std::uint64_t> keys) {
  for (const std::uint64_t key : keys) {
    state_ ^= key;
    state_ = Bits();
  }
}

std::uint64_t Random::Bits() {
  state_ += 0x9E3779B97F4A7C15U;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31U);
}

double Random::Uniform(double low, double high) {
  constexpr double kUnit = 1.0 / 9007199254740992.0;  // 2^-53
  return low + (high - low) * static_cast<double>(Bits() >> 11U) * kUnit;
}

double Random::Gauss() {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - Uniform()));
  return radius * std::cos(2.0 * M_PI * Uniform());
}

}  // namespace hv::sim
