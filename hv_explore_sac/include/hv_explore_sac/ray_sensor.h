#pragma once

#include <cstdint>
#include <vector>

#include "hv_explore_sac/belief.h"
#include "hv_explore_sac/exploration_config.h"
#include "hv_explore_sac/exploration_map.h"

namespace hv::explore {

/// The range sensor of the public dungeon benchmark: rays all around that end at their range, some
/// cells deep in an obstacle, or behind a thin one. Const methods may run concurrently.
class RaySensor {
 public:
  explicit RaySensor(const SimulationConfig& config);

  /// Writes into `belief` what is seen from a free cell of the map.
  void Sense(const ExplorationMap& map, const Eigen::Vector2i& from, Belief& belief) const;

  /// Calls `visit(index, is_free)` for every cell that is seen; some more than once.
  template <typename Visit>
  void Cast(const ExplorationMap& map, const Eigen::Vector2i& from, Visit visit) const;

 private:
  /// The cells of all rays as one tree, in which rays share the cells they have in common; parents
  /// come before their children, and all below a node lie in [its index + 1, end).
  struct Node {
    std::int16_t x;  ///< relative to the sensor
    std::int16_t y;
    std::int32_t parent;
    std::int32_t end;
  };

  int wall_depth_;
  std::vector<Node> tree_;
};

template <typename Visit>
void RaySensor::Cast(const ExplorationMap& map, const Eigen::Vector2i& from, Visit visit) const {
  thread_local std::vector<std::int16_t> memory;
  memory.resize(tree_.size());
  std::int16_t* const depths = memory.data();  // cells of obstacles on the way, for each node
  for (std::size_t i = 0; i < tree_.size();) {
    const Node& node = tree_[i];
    const int x = from.x() + node.x;
    const int y = from.y() + node.y;
    const bool inside = x >= 0 && y >= 0 && x < map.width && y < map.height;
    const int index = y * map.width + x;
    const bool is_free = inside && map.IsFree(index);
    int depth = node.parent < 0 ? 0 : depths[node.parent];
    const bool behind = is_free && depth > 0;
    depth += is_free ? 0 : 1;
    if (!inside || behind || depth > wall_depth_) {
      i = static_cast<std::size_t>(node.end);
      continue;
    }
    visit(index, is_free);
    depths[i] = static_cast<std::int16_t>(depth);
    ++i;
  }
}

}  // namespace hv::explore
