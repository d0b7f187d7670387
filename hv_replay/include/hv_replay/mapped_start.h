#pragma once

#include "hv_core/trajectory.h"
#include "hv_sim/live_config.h"
#include "hv_sim/world.h"

namespace hv::replay {

/// The simulation with a start that a map holds: the first of those drawn from its seed that is at
/// most 2.5 m from the poses of the run that made the map. A start that is given stays. Throws
/// InputError when none is found.
sim::LiveConfig WithMappedStart(sim::LiveConfig simulation, const sim::World& world,
                                const Trajectory& mapped, const Pose& T_map_world);

}  // namespace hv::replay
