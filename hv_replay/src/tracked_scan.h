#pragma once

#include <Eigen/Core>

#include "hv_lio/odometry_result.h"
#include "hv_relocalize_ndt/localizer.h"

namespace hv::replay {

/// A scan of odometry as localisation takes it; `result` has points. `lidar_in_imu`: [m].
relocalize::TrackedScan TrackedScanOf(const lio::ScanResult& result,
                                      const Eigen::Vector3d& lidar_in_imu);

}  // namespace hv::replay
