#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <hv_msgs/TrackedScan.h>
#include <Eigen/Core>

#include "hv_core/scan.h"
#include "hv_core/se3.h"
#include "hv_core/time.h"

namespace hv {

/// What a tracked scan tells beside its points.
struct TrackedScanHeader {
  Time stamp;  ///< end of the scan
  std::string odom_frame;
  std::string imu_frame;
  std::string base_frame;
  std::uint32_t segment = 0;  ///< odometry of different segments is not connected
  Pose T_odom_imu = Pose::Identity();
  Pose T_imu_base = Pose::Identity();
  Eigen::Vector3d lidar_in_imu = Eigen::Vector3d::Zero();  ///< position of the LiDAR [m]
};

/// `points`: deskewed, in the IMU frame [m]; none for a pose that is only predicted.
hv_msgs::TrackedScanPtr ToMessage(const TrackedScanHeader& header,
                                  const std::vector<Point>& points);

/// A tracked scan as read from a message. `error` is empty unless the message is unusable; then it
/// says why in one line and the rest means nothing.
struct DecodedTrackedScan {
  TrackedScanHeader header;
  std::vector<Point> points;  ///< IMU frame [m]; none for a pose that is only predicted
  std::string error;
};

/// Nothing in the message is trusted: every number is checked before it is used. Points that are
/// not finite are left out.
DecodedTrackedScan FromMessage(const hv_msgs::TrackedScan& message);

}  // namespace hv
