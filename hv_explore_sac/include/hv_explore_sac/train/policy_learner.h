#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "hv_explore_sac/nn/sac.h"
#include "hv_explore_sac/policy/policy_network.h"
#include "hv_explore_sac/train/curve.h"
#include "hv_explore_sac/train/labels.h"
#include "hv_explore_sac/train/ranks.h"
#include "hv_explore_sac/train/train_config.h"

namespace hv::explore {

/// Learns the policy of one round from labels: several networks, each for itself, and one that
/// imitates their mean. Not thread-safe; uses TBB's threads.
class PolicyLearner {
 public:
  /// Told the share that is done.
  using Report = std::function<void(double share)>;

  /// `round` counts from 0. What is learned depends on `seed` alone, whatever the threads.
  PolicyLearner(const TrainConfig& config, int round, std::uint64_t seed, Ranks& ranks,
                Report report);

  /// The networks begin as `first`, at random if that is null. Adds to `curve`; the gain is that on
  /// the labels `gauge`, which are not learned from.
  std::shared_ptr<const PolicyNetwork> Learn(const std::vector<LabelledState>& labels,
                                             const std::vector<LabelledState>& gauge,
                                             const std::shared_ptr<const PolicyNetwork>& first,
                                             std::vector<CurvePoint>& curve) const;

 private:
  /// Makes updates with random numbers of a seed; gives the mean loss.
  using Update = std::function<double(int count, std::uint64_t seed, nn::Sac& sac)>;
  /// Called every so many updates.
  using Watch = std::function<void(int count, double loss, const nn::Sac& sac)>;

  std::shared_ptr<const PolicyNetwork> Train(int which, int updates, const PolicyNetwork* first,
                                             const Update& update, const Watch& watch) const;

  TrainConfig config_;
  int round_;
  std::uint64_t seed_;
  Ranks& ranks_;
  Report report_;
};

}  // namespace hv::explore
