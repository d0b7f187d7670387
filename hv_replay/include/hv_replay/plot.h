#pragma once

#include <string>
#include <vector>

#include "hv_core/trajectory.h"
#include "hv_replay/trajectory_error.h"

namespace hv::replay {

struct NamedTrajectory {
  std::string name;
  Trajectory trajectory;
  bool is_reference = false;  ///< drawn grey and broad below the others
};

/// Draws trajectories seen from above and their height over time. The format follows from the
/// ending of `path`. Throws InputError when there is nothing to draw or it cannot be written.
void PlotTrajectories(const std::vector<NamedTrajectory>& trajectories, const std::string& title,
                      const std::string& path);

/// Draws a comparison: both paths from above with the estimate coloured by its error, height over
/// time, and translation and rotation error over time. Throws InputError like PlotTrajectories.
void PlotError(const TrajectoryError& error, const std::string& title, const std::string& path);

}  // namespace hv::replay
