#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <random>
#include <string>
#include <thread>

#include "hv_explore_sac/nn/sac.h"
#include "hv_explore_sac/online/online_config.h"
#include "hv_explore_sac/policy/policy_network.h"

namespace hv::explore {

/// What an OnlineLearner has done so far.
struct OnlineLearningStatus {
  std::size_t decisions = 0;  ///< that are remembered
  std::int64_t updates = 0;   ///< of the policy, in all sessions
  double critic_loss = 0.0;   ///< of the last update
  std::string problem;        ///< why the last attempt to save has failed; empty when it has not
};

/// Discrete SAC on what a robot meets while it explores (paper, Algorithm 1, lines 10-13), in a
/// thread of its own of low priority: nobody waits for it, and the policy that drives is not
/// touched. First the values learn what the decisions bring, then the policy too, held near the one
/// it began with.
///
/// The folder holds policy.bin, weights like those of hv_explore_train, and learner.bin and
/// replay.bin, from which the next session goes on. They are written when an exploration is
/// complete and at the end of this object. Thread-safe.
class OnlineLearner {
 public:
  /// Goes on from the folder, else from `policy`. Throws InputError for a folder that cannot be
  /// made, that is damaged, or that belongs to another network or capacity.
  OnlineLearner(const OnlineLearningConfig& config, const PolicyNetwork& policy);
  /// Remembers what has not been learned from yet, and saves.
  ~OnlineLearner();

  void Add(nn::Episode episode);
  /// Until everything added has been learned from.
  void Wait() const;

  OnlineLearningStatus status() const;
  const OnlineLearningConfig& config() const { return config_; }

 private:
  void Load();
  void Run();
  void Learn(const nn::Episode& episode);
  void Update();
  void Save();
  bool Stopping() const;
  std::string PathOf(const std::string& name) const { return config_.folder + "/" + name; }

  const OnlineLearningConfig config_;
  const PolicySettings settings_;
  // Of the thread alone, once it runs.
  nn::Sac sac_;
  nn::ReplayBuffer replay_;
  nn::ReplayBuffer returns_;  ///< for the values alone
  int value_updates_ = 0;
  std::mt19937_64 random_;

  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::deque<nn::Episode> waiting_;
  bool busy_ = false;
  bool stop_ = false;
  OnlineLearningStatus status_;
  std::thread thread_;
};

/// Null unless the configuration asks for it; `weights`: the file of the policy that drives.
/// Throws InputError.
std::shared_ptr<OnlineLearner> MakeOnlineLearner(const OnlineLearningConfig& config,
                                                 const std::string& weights);

}  // namespace hv::explore
