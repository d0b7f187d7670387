#pragma once

#include "hv_explore_sac/planner.h"
#include "map_knowledge.h"
#include "route_search.h"

namespace hv::explore {

/// Knows the map: follows a short route from which all that is still unknown can be seen, improved
/// at each decision. A bound for the others and a teacher, not a planner for robots.
class OraclePlanner : public Planner {
 public:
  /// The inputs must hold a sensor and a map; the map must outlive it.
  explicit OraclePlanner(const PlannerInputs& inputs);

  Decision Choose(const Observation& observation, const ExplorationModel& model) override;

 private:
  int FarthestKnown(int from, int to, const Observation& observation,
                    const ExplorationModel& model) const;

  PlannerConfig config_;
  MapKnowledge knowledge_;
  RouteSearch search_;
  bool first_ = true;
  std::vector<int> route_;
  mutable std::vector<int> node_of_;  ///< of each viewpoint of the model
};

}  // namespace hv::explore
