#include "hv_explore_sac/train/policy_fit.h"

#include <algorithm>
#include <random>
#include <utility>

#include <tbb/parallel_for.h>

#include "hv_explore_sac/policy/policy_input.h"

namespace hv::explore {

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
  std::mt19937_64 random(seed);
  std::vector<std::pair<std::size_t, int>> drawn(batch);  // label and symmetry
  double sum = 0.0;
  for (int i = 0; i < count; ++i) {
    for (auto& [label, symmetry] : drawn) {
      label = random() % labels.size();
      symmetry = static_cast<int>(random() % kSymmetries);
    }
    sum += sac.FitPolicy(batch, [&](std::size_t sample) {
      return ToTransition(labels[drawn[sample].first], drawn[sample].second, pyramid_levels);
    });
  }
  return sum / std::max(1, count);
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
