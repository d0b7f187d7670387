#include "hv_explore_sac/nn/sac_config.h"

#include <cmath>

namespace hv::explore::nn {
namespace {

/// Repeats the problems of a nested struct under its name.
template <typename Config>
void ValidateNested(const Config& config, const std::string& name, ConfigProblems& problems) {
  ConfigProblems nested;
  config.Validate(nested);
  for (const std::string& line : nested.lines()) {
    const std::size_t colon = line.find(": ");
    problems.Require(false, name + "." + line.substr(0, colon), line.substr(colon + 2));
  }
}

}  // namespace

void SacConfig::Describe(ConfigVisitor& visitor) {
  visitor.Section("actor", actor, "network of the policy");
  visitor.Section("critic", critic, "network of the twin action values");
  visitor.Section("actor_optimiser", actor_optimiser, "of the policy");
  visitor.Section("critic_optimiser", critic_optimiser, "of the action values");
  visitor.Field("discount", discount, "gamma, weight of the next decision's value");
  visitor.Field("soft_update", soft_update, "share by which target critics follow a step");
  visitor.Field("temperature", temperature, "alpha, weight of the entropy at the start");
  visitor.Field("tune_temperature", tune_temperature, "drives the entropy to its target");
  visitor.Field("target_entropy", target_entropy,
                "of the policy, as a share of that of the uniform one");
  visitor.Field("temperature_rate", temperature_rate, "step of the logarithm of alpha");
  visitor.Field("largest_temperature", largest_temperature, "bound of alpha while it is tuned");
  visitor.Field("prior_weight", prior_weight,
                "of the divergence from the imitating policy at the start");
  visitor.Field("prior_half_life", prior_half_life, "of that weight [updates]");
  visitor.Field("imitation_weight", imitation_weight,
                "of the cross-entropy to labels, where transitions have them");
  visitor.Field("seed", seed, "of the initial parameters");
}

void SacConfig::Validate(ConfigProblems& problems) const {
  ValidateNested(actor, "actor", problems);
  ValidateNested(critic, "critic", problems);
  ValidateNested(actor_optimiser, "actor_optimiser", problems);
  ValidateNested(critic_optimiser, "critic_optimiser", problems);
  problems.Require(discount >= 0.0 && discount < 1.0, "discount", "must be within 0 and 1");
  problems.Require(soft_update > 0.0 && soft_update <= 1.0, "soft_update",
                   "must be within 0 and 1");
  problems.Require(temperature > 0.0, "temperature", "must be positive");
  problems.Require(target_entropy >= 0.0 && target_entropy <= 1.0, "target_entropy",
                   "must be within 0 and 1");
  problems.Require(temperature_rate > 0.0, "temperature_rate", "must be positive");
  problems.Require(largest_temperature >= temperature, "largest_temperature",
                   "must not be below temperature");
  problems.Require(prior_weight >= 0.0, "prior_weight", "must not be negative");
  problems.Require(prior_half_life > 0.0, "prior_half_life", "must be positive");
  problems.Require(imitation_weight >= 0.0, "imitation_weight", "must not be negative");
  problems.Require(seed >= 0, "seed", "must not be negative");
}

double SacConfig::PriorWeight(std::int64_t updates) const {
  return prior_weight * std::exp2(-static_cast<double>(updates) / prior_half_life);
}

}  // namespace hv::explore::nn
