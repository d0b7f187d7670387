#pragma once

#include <functional>

#include "hv_explore_sac/planner.h"

namespace hv::explore {

/// Drives towards the viewpoint with the highest score among those with utility, deciding anew at
/// each viewpoint on the way; a goal stays until another one is clearly better.
class GoalPlanner : public Planner {
 public:
  /// Of a node with utility; positive.
  using Score = std::function<double(const Observation::Node&)>;

  GoalPlanner(Score score, double keep_goal) : score_(std::move(score)), keep_goal_(keep_goal) {}

  Decision Choose(const Observation& observation, const ExplorationModel& model) override;

 private:
  Score score_;
  double keep_goal_;
  Eigen::Vector2i goal_{-1, -1};  ///< its cell
};

}  // namespace hv::explore
