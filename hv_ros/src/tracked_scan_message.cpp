#include "hv_ros/tracked_scan_message.h"

#include <boost/make_shared.hpp>

#include "hv_ros/conversions.h"
#include "hv_ros/message_checks.h"

namespace hv {
namespace {

/// Returns what is wrong, or nothing.
std::string ReadHeader(const hv_msgs::TrackedScan& message, TrackedScanHeader& header) {
  if (!IsPose(message.pose)) return "its pose is not a finite rigid transform";
  if (!IsPose(message.base_pose)) return "the pose of its base is not a finite rigid transform";
  header.stamp = FromRos(message.header.stamp);
  header.odom_frame = message.header.frame_id;
  header.imu_frame = message.child_frame_id;
  header.base_frame = message.base_frame_id;
  header.segment = message.segment;
  header.T_odom_imu = FromRos(message.pose);
  header.T_imu_base = FromRos(message.base_pose);
  header.lidar_in_imu = ToVector(message.sensor_origin);
  return header.lidar_in_imu.allFinite() ? "" : "its sensor origin is not finite";
}

}  // namespace

hv_msgs::TrackedScanPtr ToMessage(const TrackedScanHeader& header,
                                  const std::vector<Point>& points) {
  auto message = boost::make_shared<hv_msgs::TrackedScan>();
  message->header.stamp = ToRos(header.stamp);
  message->header.frame_id = header.odom_frame;
  message->child_frame_id = header.imu_frame;
  message->base_frame_id = header.base_frame;
  message->segment = header.segment;
  message->pose = ToPoseMessage(header.T_odom_imu);
  message->base_pose = ToPoseMessage(header.T_imu_base);
  message->sensor_origin = ToPointMessage(header.lidar_in_imu);
  message->cloud = *ToCloudMessage(points);
  message->cloud.header.stamp = message->header.stamp;
  message->cloud.header.frame_id = header.imu_frame;
  return message;
}

DecodedTrackedScan FromMessage(const hv_msgs::TrackedScan& message) {
  DecodedTrackedScan decoded;
  decoded.error = ReadHeader(message, decoded.header);
  if (decoded.error.empty()) decoded.error = ReadPoints(message.cloud, decoded.points);
  return decoded;
}

}  // namespace hv
