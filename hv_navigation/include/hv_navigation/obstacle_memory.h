#pragma once

#include <deque>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "hv_core/time.h"
#include "hv_navigation/clearance_grid.h"
#include "hv_navigation/planar.h"

namespace hv::navigation {

/// Obstacles around the robot, as it sees them.
struct SeenObstacles {
  std::shared_ptr<const ClearanceGrid> grid;
  PlanarPose T_map_grid;

  /// Whether a place in the map is seen to be free.
  bool IsFreeAt(const Eigen::Vector2d& place) const;

  /// Places of obstacles that the map does not hold, in its frame.
  std::vector<Eigen::Vector2d> MissingIn(const ClearanceGrid& map) const;
};

/// What was in the way of the robot: it is still there when it is out of sight, until the place is
/// seen to be free, or it was too long ago. Not thread-safe.
class ObstacleMemory {
 public:
  /// `keep_s`: from then on it is forgotten.
  explicit ObstacleMemory(double keep_s) : keep_s_(keep_s) {}

  /// Takes places in the map.
  void Add(Time now, std::vector<Eigen::Vector2d> places);

  /// Forgets what is seen to be free by now, and what is too old.
  void Review(Time now, const SeenObstacles& seen);

  /// All that is left, in the map.
  std::vector<Eigen::Vector2d> Places() const;

 private:
  struct Memory {
    Time stamp;
    std::vector<Eigen::Vector2d> places;
  };

  double keep_s_;
  std::deque<Memory> memories_;  ///< oldest first
};

}  // namespace hv::navigation
