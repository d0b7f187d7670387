#include "hv_explore_sac/policy/goal_tours.h"

#include <algorithm>
#include <cmath>

namespace hv::explore {

void GoalTours::Plan(const Observation& observation, const ExplorationModel& model,
                     const std::vector<Goal>& goals) {
  size_ = static_cast<int>(goals.size());
  decay_ = kDecay / PolicyScale(model.config()).unit;
  Measure(observation, model, goals);
  Order(goals);
  const std::size_t all = (std::size_t{1} << goals.size()) - 1;
  length_.clear();
  gain_.clear();
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const float distance = observation.node(goals[i].node).distance;
    length_.push_back(distance + best_length_[all * goals.size() + i]);
    gain_.push_back(std::exp(-decay_ * distance) * best_gain_[all * goals.size() + i]);
  }
}

void GoalTours::Measure(const Observation& observation, const ExplorationModel& model,
                        const std::vector<Goal>& goals) {
  between_.clear();
  targets_.clear();
  for (const Goal& goal : goals) targets_.push_back(observation.node(goal.node).viewpoint);
  for (const Goal& from : goals) {
    search_.RunTo(model.graph(), observation.node(from.node).viewpoint, targets_);
    for (const Goal& to : goals) {
      // Edges are not always there both ways; by way of the robot's viewpoint all are joined.
      const float around =
          observation.node(from.node).distance + observation.node(to.node).distance;
      between_.push_back(std::min(search_.DistanceTo(observation.node(to.node).viewpoint), around));
    }
  }
  discount_.resize(between_.size());
  std::transform(between_.begin(), between_.end(), discount_.begin(),
                 [this](float distance) { return std::exp(-decay_ * distance); });
}

void GoalTours::Order(const std::vector<Goal>& goals) {
  const unsigned sets = 1U << goals.size();
  best_length_.assign(sets * goals.size(), 0.0F);
  best_gain_.assign(sets * goals.size(), 0.0F);
  for (unsigned set = 1; set < sets; ++set) {
    for (int first = 0; first < size_; ++first) {
      if ((set >> static_cast<unsigned>(first) & 1U) != 0) Visit(set, first, goals);
    }
  }
}

void GoalTours::Visit(unsigned set, int first, const std::vector<Goal>& goals) {
  const auto size = static_cast<unsigned>(size_);
  const unsigned rest = set & ~(1U << static_cast<unsigned>(first));
  float length = rest == 0 ? 0.0F : GraphSearch::kUnreached;
  float gain = 0.0F;
  for (unsigned next = 0; next < size; ++next) {
    if ((rest >> next & 1U) == 0) continue;
    const std::size_t pair = static_cast<unsigned>(first) * size + next;
    length = std::min(length, between_[pair] + best_length_[rest * size + next]);
    gain = std::max(gain, discount_[pair] * best_gain_[rest * size + next]);
  }
  const std::size_t at = set * size + static_cast<unsigned>(first);
  best_length_[at] = length;
  best_gain_[at] = gain + static_cast<float>(goals[static_cast<std::size_t>(first)].fresh);
}

}  // namespace hv::explore
