#include "hv_explore_sac/nn/policy.h"

#include <cmath>

namespace hv::explore::nn {

Index ActionDistribution::Best() const {
  Index best = 0;
  log_probability.maxCoeff(&best);
  return best;
}

Index ActionDistribution::Draw(double uniform) const {
  double passed = 0.0;
  for (Index action = 0; action + 1 < probability.size(); ++action) {
    passed += static_cast<double>(probability[action]);
    if (uniform < passed) return action;
  }
  return probability.size() - 1;
}

ActionDistribution ToDistribution(View<const float> scores) {
  ActionDistribution policy;
  const Eigen::VectorXf column = scores.matrix().col(0);
  const float largest = column.maxCoeff();
  const float normaliser = largest + std::log((column.array() - largest).exp().sum());
  policy.log_probability = column.array() - normaliser;
  policy.probability = policy.log_probability.array().exp();
  return policy;
}

Eigen::VectorXf ExpectationGradient(const ActionDistribution& policy, const Eigen::VectorXf& f) {
  return policy.probability.array() * (f.array() - policy.probability.dot(f));
}

}  // namespace hv::explore::nn
