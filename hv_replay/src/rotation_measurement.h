#pragma once

#include <optional>
#include <vector>

#include "hv_core/imu_sample.h"
#include "hv_core/scan.h"
#include "hv_lio/lio_config.h"
#include "hv_replay/rotation_match.h"

namespace hv::replay {

/// Measures rotation, time offset and scale between LiDAR and gyroscope. First from odometry on
/// clouds as they are, which needs nothing of the IMU; then again with the gyroscope straightening
/// the clouds at the offset found so far, until the offset settles. Nullopt when there is too
/// little data or rotation. `samples` sorted by stamp, in the units of the sensor.
std::optional<RotationMatch> MeasureRotation(const std::vector<Scan>& scans,
                                             const std::vector<ImuSample>& samples,
                                             const lio::LioConfig& config);

}  // namespace hv::replay
