#pragma once

#include <algorithm>
#include <functional>
#include <vector>

namespace hv::explore {

/// Improves an open route by reversing parts of it and moving single stops, while `cost` falls.
/// Returns the cost.
inline double ImproveOrder(std::vector<int>& route,
                           const std::function<double(const std::vector<int>&)>& cost) {
  double best = cost(route);
  std::vector<int> trial;
  const auto keep_if_better = [&] {
    const double value = cost(trial);
    if (value >= best - 1e-6) return false;
    best = value;
    route = trial;
    return true;
  };
  for (bool improved = true; improved;) {
    improved = false;
    const auto size = static_cast<std::ptrdiff_t>(route.size());
    for (std::ptrdiff_t i = 0; i < size; ++i) {
      for (std::ptrdiff_t j = 0; j < size; ++j) {
        if (i == j) continue;
        trial = route;
        if (i < j) {
          std::reverse(trial.begin() + i, trial.begin() + j + 1);
          improved |= keep_if_better();
          trial = route;
          std::rotate(trial.begin() + i, trial.begin() + i + 1, trial.begin() + j + 1);
        } else {
          std::rotate(trial.begin() + j, trial.begin() + i, trial.begin() + i + 1);
        }
        improved |= keep_if_better();
      }
    }
  }
  return best;
}

}  // namespace hv::explore
