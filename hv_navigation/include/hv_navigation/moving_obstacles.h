#pragma once

#include <deque>
#include <optional>
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
  double compare_s = 0.4;    ///< between the grids that are compared
  double flicker_s = 1.0;    ///< what was taken so shortly before is not taken newly
  double reach_m = 4.0;      ///< around the robot
  int least_cells = 2;       ///< fewer that are taken newly are noise
  int appear_cells = 4;      ///< fewer are not taken for somebody at once
  int most_cells = 60;       ///< more are an error of the pose
  double follow_s = 0.8;     ///< for how long cells newly taken are followed
  int least_sightings = 4;   ///< of cells newly taken in a line of motion; fewer are chance
  double off_line_m = 0.2;   ///< by which these may lie beside the line
  double appear_s = 0.5;     ///< what has appeared may be somebody for so long
  double hold_s = 0.6;       ///< who moved is minded, when not noticed for a moment
  double near_m = 1.0;       ///< so near to the robot people may not be seen at all
  double hold_near_s = 2.0;  ///< and are minded longer
  WalkConfig walk;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Tells what moves around the robot, people above all, from grids of obstacles: it takes cells
/// that were seen free, again and again along a line, at the pace of a walk. What only comes into
/// view takes cells too, but does not get on; until that is known, it may be somebody. Not
/// thread-safe.
class MovingObstacles {
 public:
  explicit MovingObstacles(const MovingObstaclesConfig& config) : config_(config) {}

  /// Takes the newest grid, in the frame of odometry with cells at multiples of their size, and
  /// gives who walks. `robot` is the middle of what is looked at [m].
  const std::vector<Walker>& Track(Time stamp, const OccupancyGrid& seen,
                                   const Eigen::Vector2d& robot);
  /// What has taken cells in scans one after the other of late: it may turn out to walk.
  const std::vector<Walker>& appeared() const { return appeared_; }

  void Clear() {
    past_.clear();
    sightings_.clear();
    walkers_.clear();
    appeared_.clear();
  }

 private:
  struct Past {
    Time stamp;
    OccupancyGrid grid;
  };
  /// The middle of cells newly taken that lie together [m].
  struct Sighting {
    Time stamp;
    Eigen::Vector2d place;
    int cells;
    bool stays;  ///< it was at the same place before, or is there afterwards
  };

  std::vector<Sighting> NewlyTaken(Time stamp, const OccupancyGrid& seen,
                                   const Eigen::Vector2d& robot) const;
  bool IsNew(const Eigen::Vector2d& place, Time stamp) const;
  void Recognise(Sighting& sighting);
  std::optional<Walker> Follow(const Sighting& sighting) const;
  std::optional<Walker> SlowedDown(const Sighting& sighting) const;
  int CountInLine(const Sighting& sighting, const Eigen::Vector2d& velocity) const;
  bool SightedAgain(const Sighting& sighting) const;
  void NoteAppeared(Time now, const std::vector<Sighting>& sightings);
  void Forget(Time now, const Eigen::Vector2d& robot, const std::vector<Walker>& noticed);

  MovingObstaclesConfig config_;
  std::deque<Past> past_;           ///< oldest first
  std::deque<Sighting> sightings_;  ///< of late, oldest first
  std::vector<Walker> walkers_;     ///< noticed of late, oldest first
  std::vector<Walker> appeared_;
};

}  // namespace hv::navigation
