#pragma once

#include <cstdint>
#include <vector>

#include "hv_explore_sac/exploration_config.h"
#include "hv_explore_sac/exploration_map.h"
#include "hv_explore_sac/ray_sensor.h"
#include "hv_explore_sac/viewpoint_graph.h"

namespace hv::explore {

/// Free cells of a map, of which every eighth is looked at, one bit each.
using CellSet = std::vector<std::uint64_t>;

int CountCells(const CellSet& cells);
/// Cells of `added` that are not in `cells`.
int CountMissing(const CellSet& cells, const CellSet& added);

/// The viewpoints of the whole true map, the shortest ways among all of them and what is seen from
/// each. Immutable.
class MapKnowledge {
 public:
  /// The map need not outlive it.
  MapKnowledge(const ExplorationConfig& config, const RaySensor& sensor, const ExplorationMap& map);

  static constexpr int kStride = 8;  ///< free cells for each one that is looked at

  const ViewpointGraph& graph() const { return graph_; }
  int size() const { return graph_.size(); }
  float Distance(int from, int to) const { return distance_[Index(from, to)]; }
  /// The next viewpoint on the way to `to`.
  int NextHop(int from, int to) const { return next_hop_[Index(from, to)]; }
  const CellSet& SeenFrom(int viewpoint) const {
    return seen_[static_cast<std::size_t>(viewpoint)];
  }

  int total() const { return total_; }  ///< cells that are looked at
  CellSet EmptySet() const { return CellSet(static_cast<std::size_t>(total_ + 63) / 64, 0); }
  CellSet KnownIn(const Belief& belief) const;

 private:
  std::size_t Index(int from, int to) const {
    return static_cast<std::size_t>(from) * static_cast<std::size_t>(size()) +
           static_cast<std::size_t>(to);
  }
  void NumberCells(const ExplorationMap& map);
  void FindWays();
  void FindViews(const RaySensor& sensor, const ExplorationMap& map);

  Belief truth_;
  ViewpointGraph graph_;
  int total_ = 0;
  std::vector<int> number_;  ///< of each cell of the map that is looked at, else -1
  std::vector<float> distance_;
  std::vector<int> next_hop_;
  std::vector<CellSet> seen_;
};

}  // namespace hv::explore
