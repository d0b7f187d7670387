#pragma once

#include "hv_explore_sac/belief.h"
#include "hv_explore_sac/viewpoint_graph.h"

namespace hv::explore {

/// Joins to the robot's viewpoint what it can get to over free cells but not along edges, as behind
/// narrow doors that no line between two samples passes: viewpoints are added along the way, at
/// most `spacing` [cells] apart.
void BridgeGaps(ViewpointGraph& graph, const Belief& ground, int robot, double spacing);

}  // namespace hv::explore
