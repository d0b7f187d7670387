#pragma once

#include "hv_explore_sac/planner.h"

namespace hv::explore {

/// The way out of the tree of shortest ways along which most is seen, nearer things counting more,
/// as next-best-view planners do.
class BranchPlanner : public Planner {
 public:
  explicit BranchPlanner(const PlannerConfig& config) : config_(config) {}

  Decision Choose(const Observation& observation, const ExplorationModel& model) override;

 private:
  PlannerConfig config_;
  Eigen::Vector2i goal_{-1, -1};
  std::vector<double> gain_;
};

}  // namespace hv::explore
