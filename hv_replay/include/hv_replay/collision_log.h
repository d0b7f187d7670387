#pragma once

#include <string>
#include <vector>

#include "hv_replay/csv_log.h"
#include "hv_replay/simulated_drive.h"

namespace hv::replay {

/// What a robot ran into.
struct CollisionCount {
  int collisions = 0;                     ///< the robot moved
  int hit_by_people = 0;                  ///< people walked into the robot, which stood
  std::vector<Eigen::Vector2d> contacts;  ///< where it collided, in the map [m]
};

/// Judges collisions and writes each down as a row of a CSV file.
class CollisionLog {
 public:
  /// Throws InputError when the file cannot be written.
  explicit CollisionLog(const std::string& path);

  /// Adds those of a control cycle. `trial`: told in the rows.
  void Note(const DriveCycle& cycle, const Pose& T_map_world, int trial, CollisionCount& count);

 private:
  CsvLog log_;
};

}  // namespace hv::replay
