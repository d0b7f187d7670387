#include "hv_explore_sac/train/policy_learner.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "hv_explore_sac/policy/policy_input.h"
#include "hv_explore_sac/train/fine_tuner.h"
#include "hv_explore_sac/train/policy_fit.h"

namespace hv::explore {
namespace {

/// Points of the curve, and reports, of a network.
constexpr int kPoints = 10;

}  // namespace

PolicyLearner::PolicyLearner(const TrainConfig& config, int round, std::uint64_t seed, Ranks& ranks,
                             Report report)
    : config_(config), round_(round), seed_(seed), ranks_(ranks), report_(std::move(report)) {}

std::shared_ptr<const PolicyNetwork> PolicyLearner::Learn(
    const std::vector<LabelledState>& labels, const std::vector<LabelledState>& gauge,
    const std::shared_ptr<const PolicyNetwork>& first, std::vector<CurvePoint>& curve) const {
  const ImprovementConfig& improvement = config_.improvement;
  const int levels = config_.sac.actor.pyramid_levels;
  const auto batch = static_cast<std::size_t>(std::max(1, improvement.batch / ranks_.size()));
  const Update fit = [&](int count, std::uint64_t seed, nn::Sac& sac) {
    return FitPolicy(labels, count, batch, levels, seed, sac);
  };
  const Watch note = [&](int count, double loss, const nn::Sac& sac) {
    CurvePoint point;
    point.round = round_ + 1;
    point.updates = count + (curve.empty() ? 0 : curve.back().updates);
    point.states = static_cast<int>(labels.size());
    point.loss = loss;
    point.gain = config_.labels.length_scale * MeanGain(gauge, levels, sac);
    point.travel = point.share = std::numeric_limits<double>::quiet_NaN();
    curve.push_back(point);
  };
  std::vector<std::shared_ptr<const PolicyNetwork>> networks;
  for (int which = 0; which < improvement.networks; ++which) {
    // The others' progress is much the same.
    const Watch watch = which == 0 ? note : Watch([](int, double, const nn::Sac&) {});
    networks.push_back(
        Train(which, improvement.Grown(improvement.updates, round_), first.get(), fit, watch));
  }
  if (networks.size() == 1) return networks.front();
  const Update imitate = [&](int count, std::uint64_t seed, nn::Sac& sac) {
    return ImitateMean(networks, labels, count, batch, seed, sac);
  };
  return Train(improvement.networks, improvement.Grown(improvement.imitations, round_), first.get(),
               imitate, note);
}

std::shared_ptr<const PolicyNetwork> PolicyLearner::Train(int which, int updates,
                                                          const PolicyNetwork* first,
                                                          const Update& update,
                                                          const Watch& watch) const {
  const int networks = config_.improvement.networks == 1 ? 1 : config_.improvement.networks + 1;
  nn::SacConfig learning = config_.sac;
  learning.seed += round_ * networks + which;
  learning.actor_optimiser.decay_steps = updates;
  nn::Sac sac(learning, PolicyNetwork::Shape(), PolicyInput::kGlobals);
  Reduce(ranks_, sac);
  if (first != nullptr) sac.AdoptActor(first->parameters());
  int done = 0;
  for (int point = 1; point <= kPoints; ++point) {
    const int count = updates * point / kPoints - done;
    const double loss =
        update(count, seed_ + static_cast<std::uint64_t>(which * kPoints + point), sac);
    done += count;
    watch(count, loss, sac);
    report_((which + static_cast<double>(point) / kPoints) / networks);
  }
  return std::make_shared<PolicyNetwork>(PolicySettings{config_.policy, learning.actor},
                                         sac.actor_parameters());
}

}  // namespace hv::explore
