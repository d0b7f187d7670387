#pragma once

#include <string>
#include <vector>

#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

#include "hv_sim/world.h"

/// What rviz shows of a simulated world. All functions are pure.
namespace hv::sim {

/// The triangles, shaded by their slope, without roofs and the topmost ceilings, so that one can
/// look in from above. The stamp is left to the caller.
visualization_msgs::Marker WorldMarker(const Mesh& mesh, const std::string& frame);

/// A cylinder for each person at `time_s`. The stamps are left to the caller.
visualization_msgs::MarkerArray PeopleMarkers(const std::vector<PersonPath>& people, double time_s,
                                              const std::string& frame);

}  // namespace hv::sim
