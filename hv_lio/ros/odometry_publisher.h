#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <tf2_ros/transform_broadcaster.h>

#include "body_estimate.h"
#include "hv_core/se3.h"
#include "hv_lio/keyframe_selector.h"
#include "hv_lio/odometry_result.h"
#include "hv_lio/system_config.h"
#include "hv_lio/voxel_view.h"
#include "hv_ros/path_history.h"

namespace hv::lio {

/// Everything that the odometry node sends: topics `odometry`, `odometry_imu`, `cloud_registered`,
/// `tracked_scan`, `path`, `voxels`, `keyframe` and the transform odom -> base. Clouds, path and
/// voxels are made only while somebody listens. PublishPrediction may be called from another thread
/// than the rest.
class OdometryPublisher {
 public:
  OdometryPublisher(ros::NodeHandle nh, const OutputConfig& config, bool with_imu);

  /// T_base_imu; identity until set. Not to be called while another thread publishes.
  void SetBaseFrame(const Pose& T_base_imu) { T_base_imu_ = T_base_imu; }

  /// Position of the LiDAR in the IMU frame [m], told with keyframes and tracked scans.
  /// Likewise.
  void SetLidarInImu(const Eigen::Vector3d& lidar_in_imu) { lidar_in_imu_ = lidar_in_imu; }

  /// Scans without a pose (initialising, dropped) publish nothing.
  void PublishScan(const ScanResult& result);

  /// IMU-rate odometry.
  void PublishPrediction(const OdometryEstimate& estimate) const;

  /// Whether somebody listens to `voxels` and the last picture is old enough at `stamp`.
  bool WantsVoxels(Time stamp) const;
  void PublishVoxels(const std::vector<VoxelView>& voxels, Time stamp);

 private:
  void PublishPath(const BodyEstimate& body);
  void PublishCloud(const ScanResult& result) const;
  void PublishTrackedScan(const ScanResult& result) const;
  void PublishKeyframe(const ScanResult& result);

  const OutputConfig config_;
  ros::Publisher odometry_;
  ros::Publisher odometry_imu_;
  ros::Publisher cloud_;
  ros::Publisher tracked_scan_;
  ros::Publisher path_publisher_;
  ros::Publisher voxels_;
  ros::Publisher keyframe_;
  tf2_ros::TransformBroadcaster transforms_;
  Pose T_base_imu_ = Pose::Identity();
  Eigen::Vector3d lidar_in_imu_ = Eigen::Vector3d::Zero();
  PathHistory path_;
  std::optional<Time> path_sent_;
  std::optional<Time> voxels_sent_;
  KeyframeSelector keyframes_;
};

}  // namespace hv::lio
