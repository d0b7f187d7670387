#include "hv_ros/keyframe_message.h"

#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include <Eigen/Eigenvalues>
#include <boost/make_shared.hpp>

#include "hv_ros/conversions.h"

namespace hv {
namespace {

using sensor_msgs::PointCloud2;
using sensor_msgs::PointField;

std::vector<geometry_msgs::Vector3> ToMessages(const std::vector<Eigen::Vector3d>& vectors) {
  std::vector<geometry_msgs::Vector3> messages;
  for (const Eigen::Vector3d& vector : vectors) messages.push_back(ToVectorMessage(vector));
  return messages;
}

template <typename Message>
Eigen::Vector3d ToVector(const Message& message) {
  return {message.x, message.y, message.z};
}

bool IsDirection(const Eigen::Vector3d& vector) { return vector.allFinite() && vector.norm() > 0; }

/// False when one of them is no direction.
bool ReadDirections(const std::vector<geometry_msgs::Vector3>& messages,
                    std::vector<Eigen::Vector3d>& directions) {
  for (const geometry_msgs::Vector3& message : messages) {
    directions.push_back(ToVector(message));
    if (!IsDirection(directions.back())) return false;
  }
  return true;
}

bool IsPose(const geometry_msgs::Pose& pose) {
  constexpr double kTolerance = 1e-3;
  const auto& q = pose.orientation;
  const double norm = Eigen::Vector4d(q.x, q.y, q.z, q.w).norm();
  return ToVector(pose.position).allFinite() && std::abs(norm - 1.0) < kTolerance;
}

bool IsCovariance(const Matrix6d& matrix) {
  constexpr double kTolerance = 1e-9;
  if (!matrix.allFinite()) return false;
  const double scale = matrix.cwiseAbs().maxCoeff();
  if ((matrix - matrix.transpose()).cwiseAbs().maxCoeff() > kTolerance * scale) return false;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(matrix, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().minCoeff() >= -kTolerance * scale;
}

/// Offset of a float32 field within a point; nullopt when there is none.
std::optional<std::size_t> OffsetOf(const PointCloud2& cloud, const char* name) {
  for (const PointField& field : cloud.fields) {
    const bool fits = std::size_t{field.offset} + sizeof(float) <= cloud.point_step;
    if (field.name == name && field.datatype == PointField::FLOAT32 && fits) return field.offset;
  }
  return std::nullopt;
}

bool SizesAgree(const PointCloud2& cloud) {
  const std::uint64_t row = std::uint64_t{cloud.width} * cloud.point_step;
  if (cloud.height == 0 || cloud.width == 0) return true;
  return cloud.row_step >= row &&
         (cloud.height - 1) * std::uint64_t{cloud.row_step} + row <= cloud.data.size();
}

float FloatAt(const std::uint8_t* bytes) {
  float value = 0.0F;
  std::memcpy(&value, bytes, sizeof(value));
  return value;
}

/// Returns what is wrong, or nothing.
std::string ReadPoints(const PointCloud2& cloud, std::vector<Point>& points) {
  const auto x = OffsetOf(cloud, "x");
  const auto y = OffsetOf(cloud, "y");
  const auto z = OffsetOf(cloud, "z");
  const auto intensity = OffsetOf(cloud, "intensity");
  if (!x || !y || !z) return "its cloud has no float32 fields x, y, z";
  if (cloud.is_bigendian != 0 || !SizesAgree(cloud)) return "sizes of its cloud contradict";
  for (std::size_t row = 0; row < cloud.height; ++row) {
    for (std::size_t column = 0; column < cloud.width; ++column) {
      const std::uint8_t* bytes = &cloud.data[row * cloud.row_step + column * cloud.point_step];
      Point point;
      point.x = FloatAt(bytes + *x);
      point.y = FloatAt(bytes + *y);
      point.z = FloatAt(bytes + *z);
      if (intensity) point.intensity = FloatAt(bytes + *intensity);
      const bool finite =
          std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z);
      if (finite) points.push_back(point);
    }
  }
  return "";
}

/// Everything but the cloud. Returns what is wrong, or nothing.
std::string ReadState(const hv_msgs::Keyframe& message, Keyframe& keyframe) {
  if (!IsPose(message.pose.pose)) return "its pose is not a finite rigid transform";
  keyframe.T_odom_imu = FromRos(message.pose.pose);
  keyframe.covariance = Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(
      message.pose.covariance.data());
  if (!IsCovariance(keyframe.covariance)) return "its covariance is not symmetric and positive";
  keyframe.gravity_odom = ToVector(message.gravity);
  if (!IsDirection(keyframe.gravity_odom)) return "its gravity has no direction";
  if (!ReadDirections(message.degenerate_translation, keyframe.degenerate_translation) ||
      !ReadDirections(message.degenerate_rotation, keyframe.degenerate_rotation)) {
    return "a degenerate direction has no direction";
  }
  return "";
}

}  // namespace

hv_msgs::KeyframePtr ToMessage(const Keyframe& keyframe, const KeyframeHeader& header) {
  auto message = boost::make_shared<hv_msgs::Keyframe>();
  message->header.stamp = ToRos(keyframe.stamp);
  message->header.frame_id = header.odom_frame;
  message->child_frame_id = header.imu_frame;
  message->id = keyframe.id;
  message->segment = keyframe.segment;
  message->scan_start = ToRos(header.scan_start);
  message->pose.pose = ToPoseMessage(keyframe.T_odom_imu);
  CopyCovariance(keyframe.covariance, message->pose.covariance);
  message->gravity = ToVectorMessage(keyframe.gravity_odom);
  message->degenerate_translation = ToMessages(keyframe.degenerate_translation);
  message->degenerate_rotation = ToMessages(keyframe.degenerate_rotation);
  message->sensor_origin = ToPointMessage(header.lidar_in_imu);
  message->cloud = *ToCloudMessage(keyframe.points);
  message->cloud.header.stamp = message->header.stamp;
  message->cloud.header.frame_id = header.imu_frame;
  return message;
}

DecodedKeyframe FromMessage(const hv_msgs::Keyframe& message) {
  DecodedKeyframe decoded;
  decoded.header = {FromRos(message.scan_start), message.header.frame_id, message.child_frame_id,
                    ToVector(message.sensor_origin)};
  Keyframe& keyframe = decoded.keyframe;
  keyframe.id = message.id;
  keyframe.segment = message.segment;
  keyframe.stamp = FromRos(message.header.stamp);
  decoded.error = ReadState(message, keyframe);
  if (decoded.error.empty() && !decoded.header.lidar_in_imu.allFinite()) {
    decoded.error = "its sensor origin is not finite";
  }
  if (decoded.error.empty()) decoded.error = ReadPoints(message.cloud, keyframe.points);
  return decoded;
}

}  // namespace hv
