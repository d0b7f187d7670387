#include "hv_explore_sac/nn/adam.h"

#include <algorithm>
#include <cmath>

namespace hv::explore::nn {

void AdamConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("learning_rate", learning_rate, "size of a step");
  visitor.Field("beta1", beta1, "memory of the gradient's mean");
  visitor.Field("beta2", beta2, "memory of the gradient's square");
  visitor.Field("epsilon", epsilon, "keeps steps finite where gradients vanish");
  visitor.Field("weight_decay", weight_decay, "share of a parameter lost a step, by learning rate");
  visitor.Field("clip_norm", clip_norm, "largest norm of a gradient, 0 for any");
  visitor.Field("warmup_steps", warmup_steps, "over which the learning rate rises from zero");
  visitor.Field("decay_steps", decay_steps,
                "after the warm-up over which it falls as a cosine, 0 for never");
  visitor.Field("final_share", final_share, "of the learning rate that remains after the fall");
}

void AdamConfig::Validate(ConfigProblems& problems) const {
  const auto share = [&](double value, const char* key) {
    problems.Require(value >= 0.0 && value < 1.0, key, "must be within 0 and 1");
  };
  problems.Require(learning_rate > 0.0, "learning_rate", "must be positive");
  share(beta1, "beta1");
  share(beta2, "beta2");
  problems.Require(epsilon > 0.0, "epsilon", "must be positive");
  problems.Require(weight_decay >= 0.0, "weight_decay", "must not be negative");
  problems.Require(clip_norm >= 0.0, "clip_norm", "must not be negative");
  problems.Require(warmup_steps >= 0, "warmup_steps", "must not be negative");
  problems.Require(decay_steps >= 0, "decay_steps", "must not be negative");
  problems.Require(final_share >= 0.0 && final_share <= 1.0, "final_share",
                   "must be within 0 and 1");
}

double AdamConfig::LearningRate(std::int64_t step) const {
  if (step < warmup_steps) {
    return learning_rate * static_cast<double>(step + 1) / static_cast<double>(warmup_steps);
  }
  if (decay_steps == 0) return learning_rate;
  const double passed =
      std::min(1.0, static_cast<double>(step - warmup_steps) / static_cast<double>(decay_steps));
  const double cosine = 0.5 * (1.0 + std::cos(M_PI * passed));
  return learning_rate * (final_share + (1.0 - final_share) * cosine);
}

Adam::Adam(const AdamConfig& config, Eigen::Index size)
    : config_(config), state_{Eigen::VectorXf::Zero(size), Eigen::VectorXf::Zero(size), 0} {}

double Adam::Step(Eigen::VectorXf& gradient, Eigen::VectorXf& parameters) {
  const double norm = std::sqrt(gradient.cast<double>().squaredNorm());
  if (!std::isfinite(norm)) {
    ++refused_;
    return norm;
  }
  if (config_.clip_norm > 0.0 && norm > config_.clip_norm) {
    gradient *= static_cast<float>(config_.clip_norm / norm);
  }
  const double rate = config_.LearningRate(state_.steps);
  const auto step = static_cast<double>(++state_.steps);
  const auto beta1 = static_cast<float>(config_.beta1);
  const auto beta2 = static_cast<float>(config_.beta2);
  state_.mean += (1.0F - beta1) * (gradient - state_.mean);
  state_.square += (1.0F - beta2) * (gradient.cwiseAbs2() - state_.square);
  const auto size = static_cast<float>(rate / (1.0 - std::pow(config_.beta1, step)));
  const auto square_scale = static_cast<float>(1.0 / (1.0 - std::pow(config_.beta2, step)));
  const auto epsilon = static_cast<float>(config_.epsilon);
  parameters *= static_cast<float>(1.0 - rate * config_.weight_decay);
  parameters.array() -=
      size * state_.mean.array() / ((square_scale * state_.square.array()).sqrt() + epsilon);
  return norm;
}

}  // namespace hv::explore::nn
