#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "hv_core/config.h"

namespace hv::explore::nn {

/// Optimiser and the schedule of its learning rate.
struct AdamConfig {
  double learning_rate = 3e-4;
  double beta1 = 0.9;
  double beta2 = 0.999;
  double epsilon = 1e-8;
  double weight_decay = 0.0;
  double clip_norm = 1.0;
  int warmup_steps = 100;
  int decay_steps = 0;
  double final_share = 0.1;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;

  /// Rises linearly over the warm-up, then falls as a cosine to `final_share` over `decay_steps`;
  /// `step` counts from 0.
  double LearningRate(std::int64_t step) const;
};

/// Adam with decoupled weight decay (Loshchilov and Hutter) and clipping of the gradient's norm.
class Adam {
 public:
  Adam(const AdamConfig& config, Eigen::Index size);

  /// One step along `gradient`, which is clipped in place. A gradient that is not finite is left
  /// out and counted. Gives the norm before clipping.
  double Step(Eigen::VectorXf& gradient, Eigen::VectorXf& parameters);

  std::int64_t refused() const { return refused_; }

  /// All that a checkpoint needs.
  struct State {
    Eigen::VectorXf mean;
    Eigen::VectorXf square;
    std::int64_t steps = 0;
  };
  const State& state() const { return state_; }
  void Restore(State state) { state_ = std::move(state); }

 private:
  AdamConfig config_;
  State state_;
  std::int64_t refused_ = 0;
};

/// target += rate (source - target)
inline void SoftUpdate(const Eigen::VectorXf& source, float rate, Eigen::VectorXf& target) {
  target += rate * (source - target);
}

}  // namespace hv::explore::nn
