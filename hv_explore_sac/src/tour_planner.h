#pragma once

#include <random>

#include "hv_explore_sac/planner.h"

namespace hv::explore {

/// Samples sets of viewpoints that together observe all frontier points, and drives to the first
/// stop of the shortest tour through one of them, as the local planner of TARE (Cao et al. 2021)
/// does.
class TourPlanner : public Planner {
 public:
  explicit TourPlanner(const PlannerConfig& config) : config_(config) {}

  Decision Choose(const Observation& observation, const ExplorationModel& model) override;

 private:
  struct Tour {
    std::vector<int> stops;  ///< nodes
    double length = 0.0;
  };
  void ListViews(const Observation& observation, const ExplorationModel& model);
  std::vector<int> SampleCover();
  Tour ShortTour(std::vector<int> stops, const Observation& observation,
                 const ExplorationModel& model);
  double Between(int from, int to, const Observation& observation, const ExplorationModel& model);

  PlannerConfig config_;
  std::mt19937 random_{1};
  std::vector<int> candidates_;                ///< nodes with utility
  std::vector<std::vector<int>> seen_;         ///< by each candidate: frontier points
  std::vector<std::vector<float>> distances_;  ///< from each node, once it is asked for
  GraphSearch search_;
};

}  // namespace hv::explore
