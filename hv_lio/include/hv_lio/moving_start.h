#pragma once

#include <vector>

#include "hv_core/scan.h"
#include "hv_lio/imu_propagation.h"
#include "hv_lio/initializer.h"
#include "hv_lio/odometry.h"

namespace hv::lio {

/// A scan and the IMU steps from the end of the scan before it (of the first: from its own start)
/// to its end.
struct WindowScan {
  Scan scan;
  std::vector<ImuStep> steps;
};

/// The state that `steps` lead to `state` from: undoes PropagateState step by step.
NavState CarryBack(NavState state, const std::vector<ImuStep>& steps);

/// Starts `odometry` from a moving sensor (methods section 1, dynamic initialisation). `initial`
/// is a first guess for the end of the window. The window is run through the odometry several
/// times; the state found for its end, carried back by the IMU, is where the next run starts, so
/// that the map begins with scans that are no longer skewed by unknown motion. Returns the results
/// of the last run, one a scan.
std::vector<ScanResult> StartInMotion(const std::vector<WindowScan>& window,
                                      const InitialState& initial, Odometry& odometry);

}  // namespace hv::lio
