#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace hv::replay {

/// The largest value that `share` (0 to 1) of the others do not fall below; 0 without values.
inline double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto nth =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

}  // namespace hv::replay
