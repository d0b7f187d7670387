#pragma once

#include <optional>
#include <string>
#include <vector>

#include <visualization_msgs/MarkerArray.h>

#include "hv_core/scan.h"
#include "hv_explore_sac/goal_chooser.h"

namespace hv::explore {

/// The graph of viewpoints as markers in `frame`, on the plane z = `height_m`: namespaces
/// `viewpoints` (by utility: the greener the higher; grey where there is none, blue where the robot
/// has been), `edges`, `utilities` (text), `way` (to the goal) and `goal`. Each array takes the
/// place of the one before as a whole. Empty but for that without a model.
visualization_msgs::MarkerArray ToViewpointMarkers(const GoalChooser& chooser,
                                                   const std::optional<ViewpointGoal>& goal,
                                                   const std::string& frame, double height_m);

/// Frontier points, each in the middle of its block, in the map.
std::vector<Point> FrontierCloud(const GoalChooser& chooser, double height_m);

}  // namespace hv::explore
