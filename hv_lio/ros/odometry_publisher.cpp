#include "odometry_publisher.h"

#include <hv_msgs/Keyframe.h>
#include <hv_msgs/TrackedScan.h>
#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/MarkerArray.h>

#include "body_estimate.h"
#include "conversions.h"
#include "hv_ros/conversions.h"
#include "hv_ros/keyframe_message.h"
#include "hv_ros/tracked_scan_message.h"
#include "voxel_markers.h"

namespace hv::lio {
namespace {

constexpr double kPathPeriod = 0.5;  // between two messages with the whole path [s]

/// Whether `period` has passed since `last`, or time went backwards.
bool Due(const std::optional<Time>& last, Time now, double period) {
  return !last || now < *last || now - *last >= period;
}

bool HasPose(ScanStatus status) {
  return status == ScanStatus::kTracking || status == ScanStatus::kImuOnly;
}

}  // namespace

OdometryPublisher::OdometryPublisher(ros::NodeHandle nh, const OutputConfig& config, bool with_imu)
    : config_(config),
      path_(config.path_min_distance_m, static_cast<std::size_t>(config.path_max_poses)),
      keyframes_(config.keyframe_distance_m, config.keyframe_angle_deg) {
  odometry_ = nh.advertise<nav_msgs::Odometry>("odometry", 100);
  if (with_imu) odometry_imu_ = nh.advertise<nav_msgs::Odometry>("odometry_imu", 1000);
  cloud_ = nh.advertise<sensor_msgs::PointCloud2>("cloud_registered", 10);
  tracked_scan_ = nh.advertise<hv_msgs::TrackedScan>("tracked_scan", 10);
  path_publisher_ = nh.advertise<nav_msgs::Path>("path", 2);
  voxels_ = nh.advertise<visualization_msgs::MarkerArray>("voxels", 1);
  keyframe_ = nh.advertise<hv_msgs::Keyframe>("keyframe", 50);
}

void OdometryPublisher::PublishScan(const ScanResult& result) {
  if (!HasPose(result.status)) return;
  const BodyEstimate body = MoveToBody(result.estimate, T_base_imu_);
  odometry_.publish(ToOdometryMessage(body, config_.odom_frame, config_.base_frame));
  if (config_.publish_tf) {
    transforms_.sendTransform(ToTransformMessage(body, config_.odom_frame, config_.base_frame));
  }
  PublishTrackedScan(result);
  PublishPath(body);
  if (result.status != ScanStatus::kTracking || !result.deskewed) return;
  PublishCloud(result);
  PublishKeyframe(result);
}

void OdometryPublisher::PublishPrediction(const OdometryEstimate& estimate) const {
  const BodyEstimate body = MoveToBody(estimate, T_base_imu_);
  odometry_imu_.publish(ToOdometryMessage(body, config_.odom_frame, config_.base_frame));
}

void OdometryPublisher::PublishPath(const BodyEstimate& body) {
  path_.Add(body.stamp, body.T_odom_body);
  if (path_publisher_.getNumSubscribers() == 0 || !Due(path_sent_, body.stamp, kPathPeriod)) return;
  path_publisher_.publish(path_.ToMessage(config_.odom_frame));
  path_sent_ = body.stamp;
}

void OdometryPublisher::PublishCloud(const ScanResult& result) const {
  if (cloud_.getNumSubscribers() == 0) return;
  const std::vector<Point> points = Decimated(*result.deskewed, config_.cloud_voxel_m);
  const auto message = ToCloudMessage(Transformed(result.estimate.T_odom_imu, points));
  message->header.stamp = ToRos(result.estimate.stamp);
  message->header.frame_id = config_.odom_frame;
  cloud_.publish(message);
}

void OdometryPublisher::PublishTrackedScan(const ScanResult& result) const {
  if (tracked_scan_.getNumSubscribers() == 0) return;
  TrackedScanHeader header;
  header.stamp = result.estimate.stamp;
  header.odom_frame = config_.odom_frame;
  header.imu_frame = config_.imu_frame;
  header.base_frame = config_.base_frame;
  header.segment = result.segment;
  header.T_odom_imu = result.estimate.T_odom_imu;
  header.T_imu_base = T_base_imu_.inverse();
  header.lidar_in_imu = lidar_in_imu_;
  const bool usable = result.status == ScanStatus::kTracking && result.deskewed;
  const std::vector<Point> none;
  tracked_scan_.publish(ToMessage(header, usable ? *result.deskewed : none));
}

void OdometryPublisher::PublishKeyframe(const ScanResult& result) {
  const std::optional<Keyframe> keyframe = keyframes_.Add(result);
  if (!keyframe || keyframe_.getNumSubscribers() == 0) return;
  const KeyframeHeader header{result.scan_start, config_.odom_frame, config_.imu_frame,
                              lidar_in_imu_};
  keyframe_.publish(ToMessage(*keyframe, header));
}

bool OdometryPublisher::WantsVoxels(Time stamp) const {
  return voxels_.getNumSubscribers() > 0 && Due(voxels_sent_, stamp, config_.voxels_period_s);
}

void OdometryPublisher::PublishVoxels(const std::vector<VoxelView>& voxels, Time stamp) {
  voxels_.publish(ToVoxelMarkers(voxels, config_.odom_frame, stamp));
  voxels_sent_ = stamp;
}

}  // namespace hv::lio
