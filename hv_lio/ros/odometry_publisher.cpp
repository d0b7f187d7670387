#include "odometry_publisher.h"

#include <cmath>

#include <hv_msgs/Keyframe.h>
#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/MarkerArray.h>

#include "body_estimate.h"
#include "conversions.h"
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

std::vector<geometry_msgs::Vector3> ToMessages(const std::vector<Eigen::Vector3d>& vectors) {
  std::vector<geometry_msgs::Vector3> messages;
  for (const Eigen::Vector3d& vector : vectors) messages.push_back(ToVectorMessage(vector));
  return messages;
}

hv_msgs::KeyframePtr MakeKeyframe(const ScanResult& result, const OutputConfig& config) {
  const OdometryEstimate& estimate = result.estimate;
  auto message = boost::make_shared<hv_msgs::Keyframe>();
  message->header.stamp = ToRos(estimate.stamp);
  message->header.frame_id = config.odom_frame;
  message->child_frame_id = config.imu_frame;
  message->scan_start = ToRos(result.scan_start);
  message->pose.pose = ToPoseMessage(estimate.T_odom_imu);
  CopyCovariance(estimate.pose_covariance, message->pose.covariance);
  message->gravity = ToVectorMessage(estimate.gravity_odom);
  message->degenerate_translation = ToMessages(result.update.degenerate_translation);
  message->degenerate_rotation = ToMessages(result.update.degenerate_rotation);
  message->cloud = *ToCloudMessage(*result.deskewed);
  message->cloud.header.stamp = message->header.stamp;
  message->cloud.header.frame_id = config.imu_frame;
  return message;
}

}  // namespace

OdometryPublisher::OdometryPublisher(ros::NodeHandle nh, const OutputConfig& config, bool with_imu)
    : config_(config),
      path_(config.path_min_distance_m, static_cast<std::size_t>(config.path_max_poses)) {
  odometry_ = nh.advertise<nav_msgs::Odometry>("odometry", 100);
  if (with_imu) odometry_imu_ = nh.advertise<nav_msgs::Odometry>("odometry_imu", 1000);
  cloud_ = nh.advertise<sensor_msgs::PointCloud2>("cloud_registered", 10);
  path_publisher_ = nh.advertise<nav_msgs::Path>("path", 2);
  voxels_ = nh.advertise<visualization_msgs::MarkerArray>("voxels", 1);
  keyframe_ = nh.advertise<hv_msgs::Keyframe>("keyframe", 50);
}

void OdometryPublisher::PublishScan(const ScanResult& result, std::size_t segment) {
  if (!HasPose(result.status)) return;
  const BodyEstimate body = MoveToBody(result.estimate, T_base_imu_);
  odometry_.publish(ToOdometryMessage(body, config_.odom_frame, config_.base_frame));
  if (config_.publish_tf) {
    transforms_.sendTransform(ToTransformMessage(body, config_.odom_frame, config_.base_frame));
  }
  if (segment != segment_) last_keyframe_.reset();
  segment_ = segment;
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

void OdometryPublisher::PublishKeyframe(const ScanResult& result) {
  const Pose& T_odom_imu = result.estimate.T_odom_imu;
  if (!IsKeyframe(T_odom_imu)) return;
  last_keyframe_ = T_odom_imu;
  const std::uint32_t id = keyframe_id_++;
  if (keyframe_.getNumSubscribers() == 0) return;
  const hv_msgs::KeyframePtr message = MakeKeyframe(result, config_);
  message->id = id;
  message->segment = static_cast<std::uint32_t>(segment_);
  keyframe_.publish(message);
}

bool OdometryPublisher::IsKeyframe(const Pose& T_odom_imu) const {
  if (!last_keyframe_) return true;
  const double angle_limit = config_.keyframe_angle_deg * M_PI / 180.0;
  return (T_odom_imu.translation() - last_keyframe_->translation()).norm() >=
             config_.keyframe_distance_m ||
         RotationDistance(T_odom_imu, *last_keyframe_) >= angle_limit;
}

bool OdometryPublisher::WantsVoxels(Time stamp) const {
  return voxels_.getNumSubscribers() > 0 && Due(voxels_sent_, stamp, config_.voxels_period_s);
}

void OdometryPublisher::PublishVoxels(const std::vector<VoxelView>& voxels, Time stamp) {
  voxels_.publish(ToVoxelMarkers(voxels, config_.odom_frame, stamp));
  voxels_sent_ = stamp;
}

}  // namespace hv::lio
