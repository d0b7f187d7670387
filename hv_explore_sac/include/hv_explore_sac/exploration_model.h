#pragma once

#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "hv_explore_sac/belief.h"
#include "hv_explore_sac/exploration_config.h"
#include "hv_explore_sac/frontier_views.h"
#include "hv_explore_sac/frontiers.h"
#include "hv_explore_sac/graph_search.h"
#include "hv_explore_sac/observation.h"
#include "hv_explore_sac/viewpoint_graph.h"

namespace hv::explore {

/// All that is known while exploring: the belief and what follows from it. Whoever owns it changes
/// the belief (a simulated sensor, the grid of the navigation) and calls Update(). Not thread-safe.
class ExplorationModel {
 public:
  /// `low`: the lowest cell, see Belief.
  ExplorationModel(const ExplorationConfig& config, int width, int height,
                   const Eigen::Vector2i& low = Eigen::Vector2i::Zero());

  /// From now on viewpoints and edges lie where another belief of the same cells is free: where a
  /// robot that has a size may stand; what is joined over its cells is joined by edges too. What is
  /// seen still follows from `belief()`.
  void SetGround(Belief ground) { ground_ = std::move(ground); }
  const Belief& ground() const { return ground_ ? *ground_ : belief_; }

  const ExplorationConfig& config() const { return config_; }
  Belief& belief() { return belief_; }
  const Belief& belief() const { return belief_; }
  const Frontiers& frontiers() const { return frontiers_; }
  const ViewpointGraph& graph() const { return graph_; }
  const FrontierViews& views() const { return views_; }
  const GraphSearch& ways() const { return ways_; }  ///< from the robot's viewpoint

  /// Takes over the changes of the beliefs. The robot stands at `cell`, which must be free; it
  /// becomes a viewpoint that has been visited.
  void Update(const Eigen::Vector2i& cell);

  /// For a model that is made anew of a place where the robot has been: it stood at these cells,
  /// oldest first. Those that are free become viewpoints, and what lies within `radius` [cells] of
  /// any counts as visited. The changes of the beliefs are taken over.
  void Recall(const std::vector<Eigen::Vector2i>& stood, double radius);

  int robot() const { return robot_; }  ///< its viewpoint

  /// Frontier points that a viewpoint observes; 0 when it has been visited or when they are fewer
  /// than the threshold.
  int UtilityOf(int viewpoint) const;

  void Observe(Observation& observation) const;

 private:
  void TakeChanges();
  void Remember(const Eigen::Vector2i& cell);

  ExplorationConfig config_;
  Belief belief_;
  std::optional<Belief> ground_;  ///< without: all that is free
  Frontiers frontiers_;
  ViewpointGraph graph_;
  FrontierViews views_;
  GraphSearch ways_;
  int robot_ = -1;
  std::deque<Eigen::Vector2i> history_;  ///< cells, oldest first
  mutable std::vector<int> node_of_;     ///< of each viewpoint, while an observation is made
};

}  // namespace hv::explore
