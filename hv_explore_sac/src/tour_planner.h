#pragma once

#include <random>

#include "hv_explore_sac/planner.h"

namespace hv::explore {

/// Samples sets of viewpoints that together observe all frontier points, and drives to the first
/// stop of the shortest tour through one of them, as the local planner of TARE (Cao et al. 2021)
/// does. With a decay, the best tour is the one along which most is seen, what is seen sooner
/// counting more, instead of the shortest.
class TourPlanner : public Planner {
 public:
  /// `decay` of what is seen with the way to it [1/cells]; 0 for shortest tours.
  TourPlanner(const PlannerConfig& config, double decay) : config_(config), decay_(decay) {}

  Decision Choose(const Observation& observation, const ExplorationModel& model) override;

 private:
  struct Tour {
    std::vector<int> stops;  ///< nodes
    double cost = 0.0;
  };
  void ListViews(const Observation& observation, const ExplorationModel& model);
  std::vector<int> SampleCover();
  Tour BestTour(std::vector<int> stops, const Observation& observation,
                const ExplorationModel& model);
  double CostOf(const std::vector<int>& route, const Observation& observation,
                const ExplorationModel& model);
  double Between(int from, int to, const Observation& observation, const ExplorationModel& model);

  PlannerConfig config_;
  double decay_;
  std::mt19937 random_{1};
  std::vector<int> candidates_;                ///< nodes with utility
  std::vector<std::vector<int>> seen_;         ///< by each candidate: frontier points
  std::vector<double> gain_;                   ///< points that each node adds to the cover
  std::vector<std::vector<float>> distances_;  ///< from each node, once it is asked for
  GraphSearch search_;
};

}  // namespace hv::explore
