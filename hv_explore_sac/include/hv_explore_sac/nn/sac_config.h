#pragma once

#include <cstdint>

#include "hv_explore_sac/nn/adam.h"
#include "hv_explore_sac/nn/network_config.h"

namespace hv::explore::nn {

/// Discrete soft actor-critic (paper, section 3.3; stable for discounts within 0.95 and 0.99 and
/// temperatures within 0.05 and 0.2).
struct SacConfig {
  NetworkConfig actor;
  NetworkConfig critic;
  AdamConfig actor_optimiser;
  AdamConfig critic_optimiser;
  double discount = 0.98;
  double soft_update = 0.005;
  double temperature = 0.1;
  bool tune_temperature = true;
  double target_entropy = 0.3;
  double temperature_rate = 3e-4;
  double largest_temperature = 1.0;
  double prior_weight = 0.0;
  double prior_half_life = 2000.0;
  double imitation_weight = 0.0;
  int seed = 1;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;

  /// Weight of the divergence from the prior policy after `updates`.
  double PriorWeight(std::int64_t updates) const;
};

}  // namespace hv::explore::nn
