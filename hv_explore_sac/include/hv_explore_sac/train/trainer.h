#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hv_explore_sac/policy/policy_network.h"
#include "hv_explore_sac/train/curve.h"
#include "hv_explore_sac/train/label_archive.h"
#include "hv_explore_sac/train/ranks.h"
#include "hv_explore_sac/train/train_config.h"
#include "hv_explore_sac/train/validation.h"

namespace hv::explore {

/// Policy improvement by rollouts. In each round the policy so far (first the planner `utility`)
/// explores maps; at some of its decisions every goal is tried on the true map, with that policy
/// taking all later decisions; new networks learn which goals turned out well, and one that
/// imitates their mean is the next policy. Maps kept aside tell which round's is the best. Then
/// discrete SAC goes on from that.
///
/// The folder holds policy.bin (the best so far, as the planner `sac` takes it), curve.csv, and
/// what Resume() goes on from: state.bin, last.bin (the last round's policy), labels_RANK_*.bin,
/// sac.bin, replay_RANK.bin.
/// What comes out is then the same as without the break. Not thread-safe; uses TBB's threads.
class Trainer {
 public:
  /// What is being done, for a progress line.
  using Report = std::function<void(const std::string& what, double share)>;

  /// The maps must outlive it.
  Trainer(const TrainConfig& config, const std::vector<ExplorationMap>& maps, std::string folder,
          Ranks& ranks, Report report);

  /// Goes on from the folder's last finished round with the labels made since, or from the last
  /// time that SAC's policy was tried; also when more rounds or cycles are wanted now.
  /// Throws InputError when there is none.
  void Resume();
  /// Run() improves on the policy in a file instead of the planner `utility`, and each round's
  /// networks begin as the policy of the round before: for other places or another sensor than it
  /// was made for. Throws InputError when it is no policy of this configuration.
  void BeginWith(const std::string& path);
  /// Run() takes over what another training has measured in its first round, which depends on no
  /// network: for trying other ones, or other ways to learn. Throws InputError when what it depends
  /// on differs, Run() when the maps do.
  void TakeLabels(const std::string& folder);
  /// All that is left.
  void Run();

  const std::vector<CurvePoint>& curve() const { return curve_; }
  /// Travel of the best policy on the maps for validation, as a share of `utility`'s.
  double best_share() const { return best_travel_ / utility_travel_; }
  /// The best policy, null while none is better than `utility`.
  const std::shared_ptr<const PolicyNetwork>& best() const { return best_; }

 private:
  /// What another training has measured first.
  struct Measured {
    std::string folder;
    double utility_travel;  ///< tells whether the maps are the same
    std::size_t maps;       ///< of this rank
  };

  void Begin();
  void TakeOver(const Measured& measured) const;
  void Consider(std::shared_ptr<const PolicyNetwork> candidate, double travel);
  double TravelOf(std::shared_ptr<const PolicyNetwork> policy) const;
  MapSupply MapsOfRound(const LabelConfig& labels) const;
  void RunRound();
  Rollout RolloutOf(std::shared_ptr<const PolicyNetwork> network) const;
  void CollectLabels();
  std::vector<LabelledState> Label(const std::string& name, const LabelConfig& labels,
                                   const MapSupply& maps, std::uint64_t seed) const;
  void FineTune();
  std::unique_ptr<FineTuner> MakeFineTuner();
  void Judge(std::shared_ptr<const PolicyNetwork> candidate);
  void Save() const;
  std::string PathOf(const std::string& name) const { return folder_ + "/" + name; }
  std::string RankPath(const std::string& name) const;
  std::uint64_t Seed(std::uint64_t purpose) const;

  TrainConfig config_;
  RaySensor sensor_;
  std::string folder_;
  Ranks& ranks_;
  LabelArchive archive_;
  Report report_;
  std::vector<const ExplorationMap*> training_;
  std::vector<const ExplorationMap*> validation_;
  int round_ = 0;
  int cycle_ = 0;                ///< of SAC
  double utility_travel_ = 0.0;  ///< on the maps for validation [cells]
  double best_travel_ = 0.0;
  std::optional<Measured> measured_;  ///< taken over at the beginning
  bool begun_with_policy_ = false;
  std::shared_ptr<const PolicyNetwork> last_;  ///< that rounds improve on; null: `utility`
  std::shared_ptr<const PolicyNetwork> best_;
  std::vector<LabelledState> labels_;  ///< of the kept rounds
  std::vector<LabelledState> gauge_;   ///< of the present round on maps for validation
  std::vector<CurvePoint> curve_;
};

}  // namespace hv::explore
