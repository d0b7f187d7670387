#pragma once

#include <sensor_msgs/Imu.h>
#include <sensor_msgs/PointCloud2.h>

#include "hv_core/imu_sample.h"
#include "hv_core/scan.h"
#include "hv_sim/imu_simulator.h"

/// Messages as the drivers of the sensors send them; headers are left to the caller. Pure.
namespace hv::sim {

/// Laid out as by the Hesai driver, padding included: x y z f32 at 0, intensity f32 at 16,
/// timestamp f64 (absolute seconds) at 24, ring u16 at 32, 48 bytes a point.
sensor_msgs::PointCloud2 ToHesaiCloud(const Scan& scan);

/// Without attitude; the covariances are those of the white noise.
sensor_msgs::Imu ToImuMessage(const ImuSample& sample, const ImuConfig& config);

}  // namespace hv::sim
