#pragma once

#include <string>

#include "hv_replay/json.h"
#include "hv_replay/trajectory_error.h"

namespace hv::replay {

/// The table that hv_ape prints; `colour` adds terminal colours.
std::string ErrorTable(const TrajectoryError& error, Alignment alignment, bool colour);

/// The same figures as JSON: matched, path_length_m, ape_m, vertical_m, rotation_deg, rpe, ...
JsonObject ErrorJson(const TrajectoryError& error, Alignment alignment);

}  // namespace hv::replay
