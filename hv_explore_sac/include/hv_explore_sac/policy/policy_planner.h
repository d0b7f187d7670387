#pragma once

#include <memory>
#include <optional>

#include "hv_explore_sac/planner.h"
#include "hv_explore_sac/policy/policy_input.h"
#include "hv_explore_sac/policy/policy_network.h"

namespace hv::explore {

/// Drives to the goal that the learned policy prefers, decided anew at each viewpoint.
class PolicyPlanner : public Planner {
 public:
  explicit PolicyPlanner(std::shared_ptr<const PolicyNetwork> network);
  Decision Choose(const Observation& observation, const ExplorationModel& model) override;

  /// Of the last choice: what the network read, and which of its actions was chosen.
  const nn::GraphInput& input() const { return input_; }
  int choice() const { return choice_; }

 private:
  std::shared_ptr<const PolicyNetwork> network_;
  PolicyInput builder_;
  nn::GraphInput input_;
  int choice_ = 0;
  std::optional<Eigen::Vector2i> goal_;  ///< a cell
};

}  // namespace hv::explore
