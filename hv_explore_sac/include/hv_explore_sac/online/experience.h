#pragma once

#include <optional>
#include <vector>

#include "hv_explore_sac/exploration_model.h"
#include "hv_explore_sac/nn/replay_buffer.h"
#include "hv_explore_sac/reward.h"

namespace hv::explore {

/// Puts the decisions of a robot that explores together to episodes, as simulated ones are: a
/// decision counts once the robot has driven on by the spacing of viewpoints, and its reward is
/// what came about until the next one that counts. Lengths and frontier points count as those of
/// the benchmark do (PolicyScale); of the explored share the whole is what is known afterwards. Not
/// thread-safe.
class ExperienceRecorder {
 public:
  /// Episodes are cut after `cut_after` decisions, so that what has been met can be learned from
  /// while the robot drives on.
  ExperienceRecorder(const RewardConfig& reward, int cut_after)
      : reward_(reward), cut_after_(cut_after) {}

  /// The robot decides for an action of `input`, which was made of `model`. What is returned is
  /// complete.
  std::optional<nn::Episode> Decide(const ExplorationModel& model, const nn::GraphInput& input,
                                    int action);
  /// Nothing is left to explore.
  std::optional<nn::Episode> End(const ExplorationModel& model);
  /// The exploration was broken off.
  std::optional<nn::Episode> BreakOff();

 private:
  /// What rewards are made of, at a decision.
  struct Moment {
    explicit Moment(const ExplorationModel& model);
    int free_cells;
    std::vector<Eigen::Vector2i> frontiers;
    Eigen::Vector2d centroid;
  };

  void Follow(const ExplorationModel& model);
  float RewardUntil(const Moment& now, const ExplorationModel& model, bool complete) const;
  std::optional<nn::Episode> Take(bool done);

  RewardConfig reward_;
  int cut_after_;
  nn::Episode episode_;            ///< the last step has no reward yet
  std::optional<Moment> decided_;  ///< when the last step was decided
  Eigen::Vector2i at_ = Eigen::Vector2i::Zero();
  double driven_ = 0.0;  ///< since then [cells]
};

}  // namespace hv::explore
