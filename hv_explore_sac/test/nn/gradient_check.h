#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "hv_explore_sac/nn/tensor.h"

namespace hv::explore::nn {

/// Compares the gradient of `loss` at `x` with central differences, entry by entry. `loss` reads
/// `x` where it lies.
inline void ExpectGradient(const std::function<double()>& loss, Vector<double>& x,
                           const Vector<double>& gradient, const char* what) {
  constexpr double kStep = 1e-5;
  constexpr double kTolerance = 2e-7;
  const double scale = std::max(1.0, gradient.cwiseAbs().maxCoeff());
  for (Index i = 0; i < x.size(); ++i) {
    const double kept = x[i];
    x[i] = kept + kStep;
    const double above = loss();
    x[i] = kept - kStep;
    const double below = loss();
    x[i] = kept;
    ASSERT_NEAR(gradient[i], (above - below) / (2.0 * kStep), kTolerance * scale)
        << what << ", entry " << i;
  }
}

}  // namespace hv::explore::nn
