#include <cmath>

#include "sac_sums.h"

namespace hv::explore::nn {

double Sac::Target(const Transition& transition, Workspaces& workspaces) const {
  const auto reward = static_cast<double>(transition.reward);
  if (transition.done) return reward;
  const ActionDistribution policy =
      ToDistribution(actor_.Forward(actor_parameters_.data(), transition.next, workspaces.actor));
  const View<float> values =
      critic_.Forward(target_parameters_.data(), transition.next, workspaces.critic);
  const Eigen::VectorXf least = values.matrix().rowwise().minCoeff();
  const double value = static_cast<double>(policy.probability.dot(least)) +
                       temperature() * static_cast<double>(policy.Entropy());
  return reward + config_.discount * value;
}

Matrix<float> Sac::LearnValues(const Transition& transition, double target, Workspaces& workspaces,
                               Sums& sums) const {
  const View<float> values =
      critic_.Forward(critic_parameters_.data(), transition.state, workspaces.critic);
  const Matrix<float> copy = values.matrix();
  Matrix<float> d_values = Matrix<float>::Zero(values.rows, values.cols);
  d_values.row(transition.action) =
      copy.row(transition.action).array() - static_cast<float>(target);
  sums.Note(Sums::kCriticLoss, 0.5F * d_values.squaredNorm());
  sums.Note(Sums::kValue, copy.row(transition.action).mean());
  critic_.Backward(critic_parameters_.data(), {d_values.data(), values.rows, values.cols},
                   workspaces.critic, sums.critic);
  return copy;
}

void Sac::LearnPolicy(const Transition& transition, const Matrix<float>& values,
                      Workspaces& workspaces, Sums& sums) const {
  const auto alpha = static_cast<float>(temperature());
  const Eigen::VectorXf least = values.rowwise().minCoeff();
  Eigen::VectorXf prior;
  if (prior_.size() > 0) {
    prior = ToDistribution(actor_.Forward(prior_.data(), transition.state, workspaces.actor))
                .log_probability;
  }
  const View<float> scores =
      actor_.Forward(actor_parameters_.data(), transition.state, workspaces.actor);
  const ActionDistribution policy = ToDistribution(scores);
  Eigen::VectorXf cost = alpha * policy.log_probability - least;
  if (prior.size() > 0) {
    const auto weight = static_cast<float>(config_.PriorWeight(updates_));
    const Eigen::VectorXf divergence = policy.log_probability - prior;
    sums.Note(Sums::kPriorDivergence, policy.probability.dot(divergence));
    cost += weight * divergence;
  }
  sums.Note(Sums::kActorLoss, policy.probability.dot(cost));
  const auto actions = static_cast<float>(scores.rows);
  sums.Note(Sums::kEntropy, policy.Entropy());
  sums.Note(Sums::kExcessEntropy,
            policy.Entropy() - static_cast<float>(config_.target_entropy) * std::log(actions));
  Eigen::VectorXf d_scores = ExpectationGradient(policy, cost);
  if (config_.imitation_weight > 0.0 && transition.label.size() == scores.rows) {
    d_scores +=
        static_cast<float>(config_.imitation_weight) * (policy.probability - transition.label);
  }
  actor_.Backward(actor_parameters_.data(), {d_scores.data(), scores.rows, 1}, workspaces.actor,
                  sums.actor);
}

void Sac::LearnLabel(const Transition& transition, Workspaces& workspaces, Sums& sums) const {
  const View<float> scores =
      actor_.Forward(actor_parameters_.data(), transition.state, workspaces.actor);
  if (transition.label.size() != scores.rows) return;
  const ActionDistribution policy = ToDistribution(scores);
  sums.Note(Sums::kActorLoss, -transition.label.dot(policy.log_probability));
  const Eigen::VectorXf d_scores = policy.probability - transition.label;
  actor_.Backward(actor_parameters_.data(), {d_scores.data(), scores.rows, 1}, workspaces.actor,
                  sums.actor);
}

}  // namespace hv::explore::nn
