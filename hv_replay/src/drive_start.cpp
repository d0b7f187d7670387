#include "hv_replay/drive_start.h"

#include "hv_core/error.h"

namespace hv::replay {

DriveCycle WaitForPlace(SimulatedDrive& drive) {
  constexpr double kFindPlace_s = 30.0;
  while (true) {
    const DriveCycle cycle = drive.Cycle();
    if (cycle.place && cycle.place->localized && drive.view().map) return cycle;
    if (drive.time_s() > kFindPlace_s) throw InputError("the robot does not find its place");
  }
}

Pose WorldInMap(const DriveCycle& cycle) {
  return cycle.place->T_map_odom * cycle.place->T_odom_base * cycle.T_world_base.inverse();
}

}  // namespace hv::replay
