#pragma once

#include <random>

namespace hv::explore {

/// In [0, 1), the same with every library.
inline double Uniform(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11U) * 0x1.0p-53;
}

}  // namespace hv::explore
