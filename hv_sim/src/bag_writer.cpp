#include "bag_writer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include <geometry_msgs/TransformStamped.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include "hv_core/error.h"

namespace hv::sim {
namespace {

// The layout of the Hesai driver's point type, padding included.
constexpr std::uint32_t kPointStep = 48;
constexpr std::size_t kIntensityOffset = 16;
constexpr std::size_t kTimestampOffset = 24;
constexpr std::size_t kRingOffset = 32;

BagLayout LayoutOf(const std::string& format) {
  if (format == "robot") return {"/points", "/imu", "lidar_link", "imu_link", "base_link"};
  return {"/hesai/pandar", "/alphasense/imu", "PandarXT-32", "imu_sensor_frame", ""};
}

ros::Time ToRos(Time time) {
  ros::Time stamp;
  stamp.fromNSec(static_cast<std::uint64_t>(std::max<std::int64_t>(0, time.nanoseconds())));
  return stamp;
}

sensor_msgs::PointField Field(const char* name, std::size_t offset, std::uint8_t type) {
  sensor_msgs::PointField field;
  field.name = name;
  field.offset = static_cast<std::uint32_t>(offset);
  field.datatype = type;
  field.count = 1;
  return field;
}

template <typename Value>
void Put(std::uint8_t* target, Value value) {
  std::memcpy(target, &value, sizeof(value));
}

sensor_msgs::PointCloud2 ToCloud(const Scan& scan) {
  sensor_msgs::PointCloud2 cloud;
  cloud.fields = {Field("x", 0, sensor_msgs::PointField::FLOAT32),
                  Field("y", 4, sensor_msgs::PointField::FLOAT32),
                  Field("z", 8, sensor_msgs::PointField::FLOAT32),
                  Field("intensity", kIntensityOffset, sensor_msgs::PointField::FLOAT32),
                  Field("timestamp", kTimestampOffset, sensor_msgs::PointField::FLOAT64),
                  Field("ring", kRingOffset, sensor_msgs::PointField::UINT16)};
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(scan.points.size());
  cloud.point_step = kPointStep;
  cloud.row_step = cloud.width * kPointStep;
  cloud.is_dense = true;
  cloud.data.resize(cloud.row_step);
  std::uint8_t* bytes = cloud.data.data();
  for (const Point& point : scan.points) {
    Put(bytes, point.x);
    Put(bytes + 4, point.y);
    Put(bytes + 8, point.z);
    Put(bytes + kIntensityOffset, point.intensity);
    Put(bytes + kTimestampOffset, (scan.stamp + static_cast<double>(point.time)).seconds());
    Put(bytes + kRingOffset, point.ring);
    cloud.is_dense = cloud.is_dense && std::isfinite(point.x);
    bytes += kPointStep;
  }
  return cloud;
}

geometry_msgs::TransformStamped ToTransform(const Pose& T_parent_child, const std::string& parent,
                                            const std::string& child) {
  const Eigen::Quaterniond q(T_parent_child.linear());
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = parent;
  transform.child_frame_id = child;
  transform.transform.translation.x = T_parent_child.translation().x();
  transform.transform.translation.y = T_parent_child.translation().y();
  transform.transform.translation.z = T_parent_child.translation().z();
  transform.transform.rotation.x = q.x();
  transform.transform.rotation.y = q.y();
  transform.transform.rotation.z = q.z();
  transform.transform.rotation.w = q.w();
  return transform;
}

geometry_msgs::Vector3 ToVector(const Eigen::Vector3d& v) {
  geometry_msgs::Vector3 vector;
  vector.x = v.x();
  vector.y = v.y();
  vector.z = v.z();
  return vector;
}

std::string Unfinished(const std::string& path) { return path + ".active"; }

}  // namespace

BagWriter::BagWriter(const Recording& recording, const std::string& path)
    : path_(path), layout_(LayoutOf(recording.config().format)) {
  const ImuConfig& imu = recording.config().suite.imu;
  gyro_variance_ = imu.gyro_noise * imu.gyro_noise * imu.rate_hz;
  accel_variance_ = imu.accel_noise * imu.accel_noise * imu.rate_hz;
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
      ToTransform(recording.rig().T_base_imu, layout_.base_frame, layout_.imu_frame),
      ToTransform(recording.rig().T_base_lidar, layout_.base_frame, layout_.lidar_frame)};
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
  sensor_msgs::PointCloud2 cloud = ToCloud(scan);
  cloud.header.seq = scan_sequence_++;
  cloud.header.stamp = ToRos(message.header_stamp);
  cloud.header.frame_id = layout_.lidar_frame;
  bag_.write(layout_.points_topic, ToRos(message.arrival), cloud);
}

void BagWriter::WriteImu(const SensorMessage& message, const ImuSample& sample) {
  sensor_msgs::Imu imu;
  imu.header.seq = imu_sequence_++;
  imu.header.stamp = ToRos(message.header_stamp);
  imu.header.frame_id = layout_.imu_frame;
  imu.orientation.w = 1.0;
  imu.orientation_covariance[0] = -1.0;
  imu.angular_velocity = ToVector(sample.angular_velocity);
  imu.linear_acceleration = ToVector(sample.acceleration);
  for (const std::size_t diagonal : {0U, 4U, 8U}) {
    imu.angular_velocity_covariance[diagonal] = gyro_variance_;
    imu.linear_acceleration_covariance[diagonal] = accel_variance_;
  }
  bag_.write(layout_.imu_topic, ToRos(message.arrival), imu);
}

}  // namespace hv::sim
