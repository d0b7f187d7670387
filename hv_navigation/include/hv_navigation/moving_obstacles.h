#pragma once

#include <deque>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "hv_core/config.h"
#include "hv_core/occupancy_grid.h"
#include "hv_core/time.h"
#include "hv_navigation/walkers.h"

namespace hv::navigation {

/// How what moves is told from what stands, and how it goes on.
struct MovingObstaclesConfig {
  bool predict = true;
  double compare_s = 0.4;  ///< between the grids that are compared
  double reach_m = 4.0;    ///< around the robot
  double hold_s = 0.6;     ///< what moved is minded, when it is not noticed for a moment
  int least_cells = 2;     ///< fewer that are taken newly are noise
  int most_cells = 60;     ///< more are an error of the pose
  WalkConfig walk;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Tells what moves around the robot, people above all, from grids of obstacles some time apart:
/// it takes cells that were seen free, and leaves others behind. Speeds are not measured. Not
/// thread-safe.
class MovingObstacles {
 public:
  explicit MovingObstacles(const MovingObstaclesConfig& config) : config_(config) {}

  /// Takes the newest grid, in the frame of odometry with cells at multiples of their size, and
  /// gives who walks. `robot` is the middle of what is looked at [m].
  const std::vector<Walker>& Track(Time stamp, const OccupancyGrid& seen,
                                   const Eigen::Vector2d& robot);

  void Clear() {
    past_.clear();
    walkers_.clear();
  }

 private:
  struct Past {
    Time stamp;
    OccupancyGrid grid;
  };
  struct Group;

  const OccupancyGrid* GridBefore(Time stamp);
  std::vector<Group> NewlyTaken(const OccupancyGrid& seen, const OccupancyGrid& before,
                                const Eigen::Vector2d& robot) const;
  Eigen::Vector2d DirectionOf(const Group& group, const OccupancyGrid& seen,
                              const OccupancyGrid& before) const;
  void Forget(Time now, const std::vector<Walker>& noticed);

  MovingObstaclesConfig config_;
  std::deque<Past> past_;        ///< oldest first
  std::vector<Walker> walkers_;  ///< noticed of late, oldest first
};

}  // namespace hv::navigation
