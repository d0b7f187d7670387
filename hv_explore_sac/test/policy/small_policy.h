#pragma once

#include <memory>

#include "hv_explore_sac/policy/policy_network.h"

namespace hv::explore {

/// A policy of few weights, which learned nothing. Preferences differ more with larger weights.
inline std::shared_ptr<const PolicyNetwork> RandomNetwork(std::uint64_t seed = 3,
                                                          float weights = 1.0F) {
  PolicySettings settings;
  settings.network.width = 8;
  settings.network.heads = 2;
  settings.network.feed_forward = 8;
  settings.network.encoder_layers = 1;
  settings.network.pyramid_levels = 1;
  settings.network.memory = 4;
  const nn::Network<float> network(settings.network, PolicyNetwork::Shape());
  return std::make_shared<PolicyNetwork>(settings, weights * network.layout().Initial(seed));
}

}  // namespace hv::explore
