#include "hv_ros/keyframe_message.h"

#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>
#include <boost/make_shared.hpp>

#include "hv_ros/conversions.h"
#include "hv_ros/message_checks.h"

namespace hv {
namespace {

std::vector<geometry_msgs::Vector3> ToMessages(const std::vector<Eigen::Vector3d>& vectors) {
  std::vector<geometry_msgs::Vector3> messages;
  for (const Eigen::Vector3d& vector : vectors) messages.push_back(ToVectorMessage(vector));
  return messages;
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

bool IsCovariance(const Matrix6d& matrix) {
  constexpr double kTolerance = 1e-9;
  if (!matrix.allFinite()) return false;
  const double scale = matrix.cwiseAbs().maxCoeff();
  if ((matrix - matrix.transpose()).cwiseAbs().maxCoeff() > kTolerance * scale) return false;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(matrix, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().minCoeff() >= -kTolerance * scale;
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
