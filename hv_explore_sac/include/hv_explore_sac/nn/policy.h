#pragma once

#include <vector>

#include "hv_explore_sac/nn/tensor.h"

namespace hv::explore::nn {

/// A distribution over the actions of one state.
struct ActionDistribution {
  Eigen::VectorXf log_probability;
  Eigen::VectorXf probability;

  float Entropy() const { return -probability.dot(log_probability); }
  Index Best() const;
  /// The action at which the cumulative probability passes `uniform` in [0, 1).
  Index Draw(double uniform) const;
};

/// Softmax of an actor's scores [actions x 1].
ActionDistribution ToDistribution(View<const float> scores);

/// Gradient with respect to the scores of E[f] over the actions: p (f - E[f]). It holds for
/// f = log p + ... as well, because the derivative of the logarithm adds a constant that cancels.
Eigen::VectorXf ExpectationGradient(const ActionDistribution& policy, const Eigen::VectorXf& f);

}  // namespace hv::explore::nn
