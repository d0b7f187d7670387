#include "hv_explore_sac/nn/sac.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sac_sums.h"

namespace hv::explore::nn {
namespace {

/// Seeds of the networks differ, or actor and critics would start with the same encoder.
constexpr std::uint64_t kCriticSeed = 0x9e3779b97f4a7c15ULL;

}  // namespace

Sac::Sac(const SacConfig& config, const NetworkShape& actor_shape, int critic_globals)
    : config_(config),
      actor_(config.actor, {actor_shape.node_features, actor_shape.globals, 1}),
      critic_(config.critic, {actor_shape.node_features, critic_globals, 2}),
      actor_parameters_(actor_.layout().Initial(static_cast<std::uint64_t>(config.seed))),
      critic_parameters_(
          critic_.layout().Initial(static_cast<std::uint64_t>(config.seed) + kCriticSeed)),
      target_parameters_(critic_parameters_),
      actor_optimiser_(config.actor_optimiser, actor_.layout().size()),
      critic_optimiser_(config.critic_optimiser, critic_.layout().size()),
      log_temperature_(std::log(config.temperature)),
      batch_(SumSize()) {}

SacStatistics Sac::Update(std::size_t count, const Fetch& fetch) {
  Eigen::VectorXf sums =
      RunBatch(count, [&](std::size_t sample, Workspaces& workspaces, Sums& into) {
        const Transition transition = fetch(sample);
        const double target = Target(transition, workspaces);
        const Matrix<float> values = LearnValues(transition, target, workspaces, into);
        LearnPolicy(transition, values, workspaces, into);
      });
  Eigen::VectorXf actor = sums.head(actor_.layout().size());
  Eigen::VectorXf critic = sums.segment(actor.size(), critic_.layout().size());
  const Eigen::VectorXd means = sums.tail(Sums::kStatistics).cast<double>();
  SacStatistics statistics;
  statistics.critic_loss = means[Sums::kCriticLoss];
  statistics.actor_loss = means[Sums::kActorLoss];
  statistics.value = means[Sums::kValue];
  statistics.entropy = means[Sums::kEntropy];
  statistics.excess_entropy = means[Sums::kExcessEntropy];
  statistics.prior_divergence = means[Sums::kPriorDivergence];
  statistics.critic_gradient_norm = critic_optimiser_.Step(critic, critic_parameters_);
  statistics.actor_gradient_norm = actor_optimiser_.Step(actor, actor_parameters_);
  if (config_.tune_temperature) TuneTemperature(statistics.excess_entropy);
  statistics.temperature = temperature();
  SoftUpdate(critic_parameters_, static_cast<float>(config_.soft_update), target_parameters_);
  ++updates_;
  return statistics;
}

double Sac::Imitate(std::size_t count, const Fetch& fetch) {
  return StepActor(RunBatch(count, [&](std::size_t sample, Workspaces& workspaces, Sums& into) {
    LearnLabel(fetch(sample), workspaces, into);
  }));
}

double Sac::FitPolicy(std::size_t count, const Fetch& fetch) {
  return StepActor(RunBatch(count, [&](std::size_t sample, Workspaces& workspaces, Sums& into) {
    const Transition transition = fetch(sample);
    LearnPolicy(transition, transition.returns, workspaces, into);
  }));
}

double Sac::RegressValues(std::size_t count, const Fetch& fetch) {
  return StepCritics(RunBatch(count, [&](std::size_t sample, Workspaces& workspaces, Sums& into) {
    const Transition transition = fetch(sample);
    LearnValues(transition, static_cast<double>(transition.reward), workspaces, into);
  }));
}

double Sac::StepActor(const Eigen::VectorXf& sums) {
  Eigen::VectorXf gradient = sums.head(actor_.layout().size());
  actor_optimiser_.Step(gradient, actor_parameters_);
  return static_cast<double>(sums.tail(Sums::kStatistics)[Sums::kActorLoss]);
}

double Sac::StepCritics(const Eigen::VectorXf& sums) {
  Eigen::VectorXf gradient = sums.segment(actor_.layout().size(), critic_.layout().size());
  critic_optimiser_.Step(gradient, critic_parameters_);
  target_parameters_ = critic_parameters_;
  return static_cast<double>(sums.tail(Sums::kStatistics)[Sums::kCriticLoss]);
}

void Sac::AdoptActor(const Eigen::VectorXf& parameters) {
  if (parameters.size() != actor_parameters_.size()) {
    throw std::invalid_argument("the policy to adopt has another shape");
  }
  actor_parameters_ = parameters;
}

Eigen::VectorXf Sac::RunBatch(std::size_t count,
                              const std::function<void(std::size_t, Workspaces&, Sums&)>& learn) {
  const Index actor = actor_.layout().size();
  const Index critic = critic_.layout().size();
  Eigen::VectorXf sums = batch_.Run(count, [&](std::size_t sample, float* sum) {
    const Pool<Workspaces>::Loan workspaces(pool_);
    Sums into{sum, sum + actor, sum + actor + critic};
    learn(sample, *workspaces, into);
  });
  auto samples = static_cast<double>(count);
  if (reduce) reduce(sums, samples);
  sums /= static_cast<float>(std::max(samples, 1.0));
  return sums;
}

void Sac::TuneTemperature(double excess_entropy) {
  log_temperature_ -= config_.temperature_rate * excess_entropy;
  log_temperature_ = std::min(log_temperature_, std::log(config_.largest_temperature));
}

double Sac::temperature() const { return std::exp(log_temperature_); }

Index Sac::SumSize() const {
  return actor_.layout().size() + critic_.layout().size() + Sums::kStatistics;
}

ActionDistribution Sac::Policy(const GraphSample& sample) const {
  const Pool<Workspaces>::Loan workspaces(pool_);
  return ToDistribution(actor_.Forward(actor_parameters_.data(), sample, workspaces->actor));
}

Matrix<float> Sac::Values(const GraphSample& sample) const {
  const Pool<Workspaces>::Loan workspaces(pool_);
  return critic_.Forward(critic_parameters_.data(), sample, workspaces->critic).matrix();
}

void Sac::Save(Checkpoint& checkpoint) const {
  checkpoint.Put("actor", actor_.layout(), actor_parameters_);
  checkpoint.Put("critic", critic_.layout(), critic_parameters_);
  checkpoint.Put("target", critic_.layout(), target_parameters_);
  if (prior_.size() > 0) checkpoint.Put("prior", actor_.layout(), prior_);
  checkpoint.PutNumber("has_prior", prior_.size() > 0 ? 1.0 : 0.0);
  checkpoint.Put("actor_optimiser", actor_.layout(), actor_optimiser_.state());
  checkpoint.Put("critic_optimiser", critic_.layout(), critic_optimiser_.state());
  checkpoint.PutNumber("log_temperature", log_temperature_);
  checkpoint.PutNumber("updates", static_cast<double>(updates_));
}

void Sac::Load(const Checkpoint& checkpoint) {
  Eigen::VectorXf actor = checkpoint.Parameters("actor", actor_.layout());
  Eigen::VectorXf critic = checkpoint.Parameters("critic", critic_.layout());
  Eigen::VectorXf target = checkpoint.Parameters("target", critic_.layout());
  Eigen::VectorXf prior;
  if (checkpoint.Number("has_prior") > 0.0) {
    prior = checkpoint.Parameters("prior", actor_.layout());
  }
  Adam::State actor_state = checkpoint.AdamState("actor_optimiser", actor_.layout());
  Adam::State critic_state = checkpoint.AdamState("critic_optimiser", critic_.layout());
  const double log_temperature = checkpoint.Number("log_temperature");
  const double updates = checkpoint.Number("updates");
  actor_parameters_ = std::move(actor);
  critic_parameters_ = std::move(critic);
  target_parameters_ = std::move(target);
  prior_ = std::move(prior);
  actor_optimiser_.Restore(std::move(actor_state));
  critic_optimiser_.Restore(std::move(critic_state));
  log_temperature_ = log_temperature;
  updates_ = static_cast<std::int64_t>(updates);
}

}  // namespace hv::explore::nn
