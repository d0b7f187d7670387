#pragma once

#include <vector>

#include "hv_explore_sac/belief.h"
#include "hv_explore_sac/exploration_config.h"
#include "hv_explore_sac/frontiers.h"
#include "hv_explore_sac/viewpoint_graph.h"

namespace hv::explore {

/// Which frontier points each viewpoint observes: those within range to which the line through the
/// belief is free. With `new_side_deg`, of those only the ones that the robot has not seen from as
/// near and the same side yet: another look would show nothing new. Not thread-safe.
class FrontierViews {
 public:
  explicit FrontierViews(const ViewpointConfig& config) : config_(config) {}

  /// Follows the belief, the frontiers and the graph, all of which must have been updated before.
  void Update(const Belief& belief, const Frontiers& frontiers, const ViewpointGraph& graph);

  /// The points that a viewpoint observes.
  void ListSeen(int viewpoint, std::vector<int>& points) const;
  int CountSeen(int viewpoint) const { return seen_[static_cast<std::size_t>(viewpoint)]; }

 private:
  struct View {
    int point;
    int blocked;         ///< a cell in the way, or Belief::kNone
    bool known = false;  ///< the robot has had such a view
  };
  static bool Observes(const View& view) { return view.blocked == Belief::kNone && !view.known; }
  void Restart();
  void Follow(int viewpoint, const Eigen::Vector2i& cell, const Belief& belief,
              const Frontiers& frontiers);
  void Look(int viewpoint, const Eigen::Vector2i& cell, const std::vector<int>& points,
            const Belief& belief, const Frontiers& frontiers);
  void FindKnown(const Frontiers& frontiers, const ViewpointGraph& graph);

  ViewpointConfig config_;
  int renumberings_ = 0;
  std::vector<std::vector<View>> views_;  ///< of each viewpoint: all points within range
  std::vector<int> seen_;                 ///< of each viewpoint
};

}  // namespace hv::explore
