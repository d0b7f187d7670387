#pragma once

#include "hv_replay/simulated_drive.h"

namespace hv::replay {

/// Lets a robot stand until odometry has started, its place in the map is found and there is a grid
/// to plan in. Returns the last cycle. Throws InputError when that takes more than 30 s.
DriveCycle WaitForPlace(SimulatedDrive& drive);

/// T_map_world if the place that the robot takes itself to be at is right.
Pose WorldInMap(const DriveCycle& cycle);

}  // namespace hv::replay
