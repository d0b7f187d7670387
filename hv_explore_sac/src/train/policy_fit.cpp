#include "hv_explore_sac/train/policy_fit.h"

#include <algorithm>
#include <functional>
#include <random>

#include <tbb/parallel_for.h>

#include "hv_explore_sac/policy/policy_input.h"

namespace hv::explore {
namespace {

struct Drawn {
  const LabelledState* label;
  int symmetry;
};

/// Calls `update` with states drawn at random and random mirrors for them, `count` times; gives the
/// mean of what it returns.
double Repeat(const std::vector<LabelledState>& labels, int count, std::size_t batch,
              std::uint64_t seed, const std::function<double(const std::vector<Drawn>&)>& update) {
  std::mt19937_64 random(seed);
  std::vector<Drawn> drawn(batch);
  double sum = 0.0;
  for (int i = 0; i < count; ++i) {
    for (Drawn& each : drawn) {
      each.label = &labels[random() % labels.size()];
      each.symmetry = static_cast<int>(random() % kSymmetries);
    }
    sum += update(drawn);
  }
  return sum / std::max(1, count);
}

Eigen::VectorXf MeanPreference(const std::vector<std::shared_ptr<const PolicyNetwork>>& policies,
                               const nn::GraphInput& input) {
  Eigen::VectorXf scores = Eigen::VectorXf::Zero(static_cast<Eigen::Index>(input.actions.size()));
  for (const std::shared_ptr<const PolicyNetwork>& policy : policies) {
    scores += policy->Choose(input).log_probability;
  }
  scores /= static_cast<float>(policies.size());
  return nn::ToDistribution({scores.data(), scores.size(), 1}).probability;
}

}  // namespace

nn::Transition ToTransition(const LabelledState& label, int symmetry, int pyramid_levels) {
  nn::GraphInput input = label.state.Unpack();
  Transform(symmetry, input);
  nn::Transition transition;
  transition.state = nn::BuildSample(input, pyramid_levels);
  transition.returns = label.returns.array() - label.returns.mean();
  transition.done = true;
  return transition;
}

double FitPolicy(const std::vector<LabelledState>& labels, int count, std::size_t batch,
                 int pyramid_levels, std::uint64_t seed, nn::Sac& sac) {
  return Repeat(labels, count, batch, seed, [&](const std::vector<Drawn>& drawn) {
    return sac.FitPolicy(batch, [&](std::size_t sample) {
      return ToTransition(*drawn[sample].label, drawn[sample].symmetry, pyramid_levels);
    });
  });
}

double ImitateMean(const std::vector<std::shared_ptr<const PolicyNetwork>>& policies,
                   const std::vector<LabelledState>& labels, int count, std::size_t batch,
                   std::uint64_t seed, nn::Sac& sac) {
  return Repeat(labels, count, batch, seed, [&](const std::vector<Drawn>& drawn) {
    return sac.Imitate(batch, [&](std::size_t sample) {
      nn::GraphInput input = drawn[sample].label->state.Unpack();
      Transform(drawn[sample].symmetry, input);
      nn::Transition transition;
      transition.state = nn::BuildSample(input, sac.actor().config().pyramid_levels);
      transition.label = MeanPreference(policies, input);
      return transition;
    });
  });
}

double MeanGain(const std::vector<LabelledState>& labels, int pyramid_levels, const nn::Sac& sac) {
  std::vector<double> gains(labels.size());
  tbb::parallel_for(std::size_t{0}, labels.size(), [&](std::size_t i) {
    const nn::Transition transition = ToTransition(labels[i], 0, pyramid_levels);
    const Eigen::Index choice = sac.Policy(transition.state).Best();
    gains[i] = static_cast<double>(transition.returns[choice] - transition.returns[0]);
  });
  double sum = 0.0;
  for (const double gain : gains) sum += gain;
  return gains.empty() ? 0.0 : sum / static_cast<double>(gains.size());
}

}  // namespace hv::explore
