#pragma once

#include <deque>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "hv_core/config.h"
#include "hv_core/occupancy_grid.h"
#include "hv_core/time.h"

namespace hv::navigation {

/// How what moves is told from what stands, and where it may get to.
struct MovingObstaclesConfig {
  bool predict = true;
  double compare_s = 0.4;  ///< between the grids that are compared
  double reach_m = 4.0;    ///< around the robot
  double speed_mps = 1.2;  ///< of a walking person
  double horizon_s = 1.0;  ///< it goes on straight for so long
  double hold_s = 0.6;     ///< what moved is minded, when it is not noticed for a moment
  double radius_m = 0.3;   ///< of a person
  int least_cells = 2;     ///< fewer that are taken newly are noise
  int most_cells = 60;     ///< more are an error of the pose

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Tells what moves around the robot, people above all, from grids of obstacles some time apart:
/// it takes cells that were seen free, and leaves others behind. Speeds are not measured: who walks
/// is taken to walk on. Not thread-safe.
class MovingObstacles {
 public:
  explicit MovingObstacles(const MovingObstaclesConfig& config) : config_(config) {}

  /// Takes the newest grid, in the frame of odometry with cells at multiples of their size, and
  /// gives the cells that what moves may come to. `robot` is the middle of what is looked at [m].
  std::vector<Eigen::Vector2i> Predict(Time stamp, const OccupancyGrid& seen,
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
  struct Walker {
    Time stamp;
    Eigen::Vector2d place;      ///< [m]
    Eigen::Vector2d direction;  ///< unit
  };

  const OccupancyGrid* GridBefore(Time stamp);
  std::vector<Group> NewlyTaken(const OccupancyGrid& seen, const OccupancyGrid& before,
                                const Eigen::Vector2d& robot) const;
  Eigen::Vector2d DirectionOf(const Group& group, const OccupancyGrid& seen,
                              const OccupancyGrid& before) const;
  void Sweep(const Walker& walker, Time now, const OccupancyGrid& seen,
             std::vector<Eigen::Vector2i>& cells) const;

  MovingObstaclesConfig config_;
  std::deque<Past> past_;       ///< oldest first
  std::deque<Walker> walkers_;  ///< noticed of late, oldest first
};

}  // namespace hv::navigation
