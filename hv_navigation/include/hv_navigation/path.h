#pragma once

#include <optional>
#include <vector>

#include "hv_navigation/clearance_grid.h"
#include "hv_navigation/footprint.h"
#include "hv_navigation/planar.h"

namespace hv::navigation {

/// Poses in the order in which they are driven, close together. Two poses at the same place are a
/// turn on the spot, the shorter way round.
using Path = std::vector<PlanarPose>;

/// Driven distance; turns count nothing [m].
double Length(const Path& path);

/// The first pose from `from` on at which the robot would touch an obstacle; nullopt when all are
/// free. Poses beyond `distance_m` of driving are not looked at.
std::optional<std::size_t> FirstCollision(const Path& path, const ClearanceGrid& grid,
                                          const Footprint& footprint, std::size_t from,
                                          double distance_m);

}  // namespace hv::navigation
