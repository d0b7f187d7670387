#include "bag_writer.h"

#include <filesystem>

#include <geometry_msgs/TransformStamped.h>
#include <tf2_msgs/TFMessage.h>

#include "hv_core/error.h"
#include "hv_ros/conversions.h"
#include "sensor_messages.h"

namespace hv::sim {
namespace {

BagLayout LayoutOf(const std::string& format) {
  if (format == "robot") return {"/points", "/imu", "lidar_link", "imu_link", "base_link"};
  return {"/hesai/pandar", "/alphasense/imu", "PandarXT-32", "imu_sensor_frame", ""};
}

geometry_msgs::TransformStamped ToStamped(const Pose& T_parent_child, const std::string& parent,
                                          const std::string& child) {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = parent;
  transform.child_frame_id = child;
  transform.transform = ToTransform(T_parent_child);
  return transform;
}

std::string Unfinished(const std::string& path) { return path + ".active"; }

}  // namespace

BagWriter::BagWriter(const Recording& recording, const std::string& path)
    : path_(path),
      layout_(LayoutOf(recording.config().format)),
      imu_config_(recording.config().suite.imu) {
  try {
    bag_.open(Unfinished(path_), rosbag::bagmode::Write);
  } catch (const rosbag::BagException& error) {
    throw InputError(path_ + ": cannot be written: " + error.what());
  }
  bag_.setCompression(rosbag::compression::LZ4);
  if (!layout_.base_frame.empty()) WriteStaticTransforms(recording);
}

void BagWriter::Write(const SensorMessage& message) {
  if (const Scan* scan = std::get_if<Scan>(&message.data)) {
    WriteScan(message, *scan);
  } else {
    WriteImu(message, std::get<ImuSample>(message.data));
  }
}

void BagWriter::Finish() {
  bag_.close();
  std::error_code error;
  std::filesystem::rename(Unfinished(path_), path_, error);
  if (error) throw InputError(path_ + ": cannot be written: " + error.message());
}

void BagWriter::WriteStaticTransforms(const Recording& recording) {
  const ros::Time start = ToRos(Time::FromSeconds(recording.config().suite.epoch_s));
  tf2_msgs::TFMessage message;
  message.transforms = {
      ToStamped(recording.rig().T_base_imu, layout_.base_frame, layout_.imu_frame),
      ToStamped(recording.rig().T_base_lidar, layout_.base_frame, layout_.lidar_frame)};
  for (geometry_msgs::TransformStamped& transform : message.transforms) {
    transform.header.stamp = start;
  }
  const auto connection = boost::make_shared<ros::M_string>();
  (*connection)["type"] = "tf2_msgs/TFMessage";
  (*connection)["md5sum"] = ros::message_traits::md5sum(message);
  (*connection)["message_definition"] = ros::message_traits::definition(message);
  (*connection)["latching"] = "1";
  (*connection)["callerid"] = "/hv_simulate";
  bag_.write("/tf_static", start, message, connection);
}

void BagWriter::WriteScan(const SensorMessage& message, const Scan& scan) {
  sensor_msgs::PointCloud2 cloud = ToHesaiCloud(scan);
  cloud.header.seq = scan_sequence_++;
  cloud.header.stamp = ToRos(message.header_stamp);
  cloud.header.frame_id = layout_.lidar_frame;
  bag_.write(layout_.points_topic, ToRos(message.arrival), cloud);
}

void BagWriter::WriteImu(const SensorMessage& message, const ImuSample& sample) {
  sensor_msgs::Imu imu = ToImuMessage(sample, imu_config_);
  imu.header.seq = imu_sequence_++;
  imu.header.stamp = ToRos(message.header_stamp);
  imu.header.frame_id = layout_.imu_frame;
  bag_.write(layout_.imu_topic, ToRos(message.arrival), imu);
}

}  // namespace hv::sim
