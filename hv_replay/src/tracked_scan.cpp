#include "tracked_scan.h"

namespace hv::replay {

relocalize::TrackedScan TrackedScanOf(const lio::ScanResult& result,
                                      const Eigen::Vector3d& lidar_in_imu) {
  relocalize::TrackedScan scan;
  scan.stamp = result.estimate.stamp;
  scan.T_odom_imu = result.estimate.T_odom_imu;
  scan.segment = result.segment;
  scan.lidar_in_imu = lidar_in_imu;
  scan.points.reserve(result.deskewed->size());
  for (const Point& point : *result.deskewed) scan.points.emplace_back(point.x, point.y, point.z);
  return scan;
}

}  // namespace hv::replay
