#pragma once

#include <functional>

#include "hv_explore_sac/nn/batch.h"
#include "hv_explore_sac/nn/checkpoint.h"
#include "hv_explore_sac/nn/network.h"
#include "hv_explore_sac/nn/policy.h"
#include "hv_explore_sac/nn/replay_buffer.h"
#include "hv_explore_sac/nn/sac_config.h"

namespace hv::explore::nn {

/// Means over the batch of one update.
struct SacStatistics {
  double critic_loss = 0.0;
  double actor_loss = 0.0;
  double value = 0.0;
  double entropy = 0.0;
  /// Entropy minus its target.
  double excess_entropy = 0.0;
  double prior_divergence = 0.0;
  double temperature = 0.0;
  double actor_gradient_norm = 0.0;
  double critic_gradient_norm = 0.0;
};

/// Discrete soft actor-critic on graphs (paper, section 3.3 and Algorithm 1):
///
///   y     = r + gamma (1 - d) sum_a pi(a|s') [min(Q1', Q2')(s', a) - alpha log pi(a|s')]
///   J_Q   = (Q1(s, a) - y)^2 / 2 + (Q2(s, a) - y)^2 / 2
///   J_pi  = sum_a pi(a|s) [alpha log pi(a|s) - min(Q1, Q2)(s, a)]
///           + kappa KL(pi | prior) + imitation_weight cross-entropy(label, pi)
///   alpha follows the target entropy; Q' follows Q softly.
///
/// The actor has an encoder of its own, so that the errors of values never bend its features, and
/// can run alone on the robot. The twin critics share one encoder and differ in their decoders'
/// heads: an encoder is nearly all of the cost, and a second one would make an update half as
/// long again. A critic with more `globals` than the actor sees what the robot cannot (the true
/// map), which serves learning only.
///
/// Update() and its kin use all threads of TBB's arena and give the same numbers for any of them;
/// one caller at a time.
class Sac {
 public:
  using Fetch = std::function<Transition(std::size_t)>;

  Sac(const SacConfig& config, const NetworkShape& actor_shape, int critic_globals);

  /// One step of critics, actor, temperature and targets on `count` transitions, which `fetch`
  /// gives from several threads.
  SacStatistics Update(std::size_t count, const Fetch& fetch);

  /// One step of the actor alone towards the labels; gives the mean cross-entropy.
  double Imitate(std::size_t count, const Fetch& fetch);
  /// One step of the critics alone towards rewards taken as whole returns of the actions, after
  /// which targets equal critics; gives the mean loss.
  double RegressValues(std::size_t count, const Fetch& fetch);
  /// One step of the actor alone on J_pi with the measured `returns` in place of the critics'. It
  /// is linear in them, so that noise of the measurements averages out over states. Gives the mean
  /// of the loss.
  double FitPolicy(std::size_t count, const Fetch& fetch);
  /// Takes over a policy of the same shape that was learned elsewhere. Throws
  /// std::invalid_argument.
  void AdoptActor(const Eigen::VectorXf& parameters);
  /// The present actor becomes the prior from which J_pi punishes divergence.
  void KeepPrior() { prior_ = actor_parameters_; }

  /// The policy at one state. Thread-safe with other calls of its kind.
  ActionDistribution Policy(const GraphSample& sample) const;
  /// [actions x 2]
  Matrix<float> Values(const GraphSample& sample) const;

  void Save(Checkpoint& checkpoint) const;
  /// Throws InputError when something is missing or of another shape; `this` is then as before.
  void Load(const Checkpoint& checkpoint);

  const Network<float>& actor() const { return actor_; }
  const Eigen::VectorXf& actor_parameters() const { return actor_parameters_; }
  const Network<float>& critic() const { return critic_; }
  const Eigen::VectorXf& critic_parameters() const { return critic_parameters_; }
  double temperature() const;
  std::int64_t updates() const { return updates_; }

  /// Called on the summed gradients (actor, critics, sums of the statistics) and the number of
  /// samples before each step: the place to add up over ranks. Does nothing by itself.
  std::function<void(Eigen::VectorXf& sums, double& samples)> reduce;

 private:
  struct Workspaces {
    Network<float>::Workspace actor;
    Network<float>::Workspace critic;
  };
  /// What the losses of one sample add to.
  struct Sums;

  double Target(const Transition& transition, Workspaces& workspaces) const;
  Matrix<float> LearnValues(const Transition& transition, double target, Workspaces& workspaces,
                            Sums& sums) const;
  void LearnPolicy(const Transition& transition, const Matrix<float>& values,
                   Workspaces& workspaces, Sums& sums) const;
  double StepActor(const Eigen::VectorXf& sums);
  double StepCritics(const Eigen::VectorXf& sums);
  void LearnLabel(const Transition& transition, Workspaces& workspaces, Sums& sums) const;
  Eigen::VectorXf RunBatch(std::size_t count,
                           const std::function<void(std::size_t, Workspaces&, Sums&)>& learn);
  void TuneTemperature(double excess_entropy);
  Index SumSize() const;

  SacConfig config_;
  Network<float> actor_;
  Network<float> critic_;
  Eigen::VectorXf actor_parameters_;
  Eigen::VectorXf critic_parameters_;
  Eigen::VectorXf target_parameters_;
  /// Empty without a prior.
  Eigen::VectorXf prior_;
  Adam actor_optimiser_;
  Adam critic_optimiser_;
  double log_temperature_;
  std::int64_t updates_ = 0;
  BatchSum batch_;
  mutable Pool<Workspaces> pool_;
};

}  // namespace hv::explore::nn
