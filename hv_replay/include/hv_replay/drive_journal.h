#pragma once

#include <string>

#include "hv_replay/collision_log.h"
#include "hv_replay/csv_log.h"
#include "hv_replay/navigation_trial.h"
#include "hv_replay/simulated_drive.h"

namespace hv::replay {

/// Takes a drive down, cycle by cycle: into files, and into what is judged of it.
class DriveJournal {
 public:
  /// Begins cycles.csv and collisions.csv in `folder`. Throws InputError when they cannot be
  /// written.
  explicit DriveJournal(const std::string& folder);

  /// `T_map_world`: the truth of the map.
  void Note(const DriveCycle& cycle, const Pose& T_map_world, NavigationTrial& trial);

 private:
  void Log(const DriveCycle& cycle, const navigation::PlanarPose& truth, int trial);

  CollisionLog collision_log_;
  CsvLog cycle_log_;
};

}  // namespace hv::replay
