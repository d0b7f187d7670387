#pragma once

#include <vector>

#include "hv_explore_sac/exploration_model.h"
#include "hv_explore_sac/observation.h"
#include "hv_explore_sac/policy/goals.h"

namespace hv::explore {

/// What the choice of the first goal means for the others: shortest ways between all pairs, and the
/// best orders in which all are visited, for each first goal (dynamic programming over subsets).
/// Not thread-safe.
class GoalTours {
 public:
  static constexpr int kMostGoals = 12;

  void Plan(const Observation& observation, const ExplorationModel& model,
            const std::vector<Goal>& goals);

  int size() const { return size_; }
  /// Length of the shortest way between two goals [cells].
  float Between(int from, int to) const {
    return between_[static_cast<std::size_t>(from * size_ + to)];
  }
  /// Length of the shortest way from the robot to this goal and on through all others [cells].
  float LengthVia(int goal) const { return length_[static_cast<std::size_t>(goal)]; }
  /// The most that the fresh frontier points of all goals sum up to when this one comes first and
  /// each counts exp(-decay x length of the way up to it).
  float GainVia(int goal) const { return gain_[static_cast<std::size_t>(goal)]; }

  static constexpr float kDecay = 0.01F;  ///< of the gain [1/units of PolicyScale]

 private:
  void Measure(const Observation& observation, const ExplorationModel& model,
               const std::vector<Goal>& goals);
  void Order(const std::vector<Goal>& goals);
  void Visit(unsigned set, int first, const std::vector<Goal>& goals);

  int size_ = 0;
  float decay_ = kDecay;  ///< [1/cells]
  GraphSearch search_;
  std::vector<int> targets_;  ///< the goals' viewpoints
  std::vector<float> between_;
  std::vector<float> length_;
  std::vector<float> gain_;
  std::vector<float> discount_;     ///< exp(-decay x way) between each pair
  std::vector<float> best_length_;  ///< of each set and first goal in it
  std::vector<float> best_gain_;
};

}  // namespace hv::explore
