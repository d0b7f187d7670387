#pragma once

#include <string>

#include <visualization_msgs/MarkerArray.h>

#include "loop_engine.h"

namespace hv::loop {

/// The pose graph as markers in `frame`, namespaces `keyframes`, `odometry`, `loops_accepted`
/// (green), `loops_refused` (red: by the fine alignment or by the graph), `loops_undecided` (grey)
/// and `scores` (text, of the newest accepted loops). Candidates that were never aligned are not
/// shown. Each namespace is replaced as a whole by the next array.
visualization_msgs::MarkerArray ToLoopMarkers(const LoopView& view, const std::string& frame);

}  // namespace hv::loop
