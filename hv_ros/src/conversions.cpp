#include "hv_ros/conversions.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <unordered_set>

#include <boost/make_shared.hpp>

namespace hv {
namespace {

constexpr std::size_t kPointStep = 16;  // four float32

void SetFields(sensor_msgs::PointCloud2& cloud) {
  const char* names[] = {"x", "y", "z", "intensity"};
  cloud.fields.resize(4);
  for (std::size_t i = 0; i < 4; ++i) {
    cloud.fields[i].name = names[i];
    cloud.fields[i].offset = static_cast<std::uint32_t>(i * sizeof(float));
    cloud.fields[i].datatype = sensor_msgs::PointField::FLOAT32;
    cloud.fields[i].count = 1;
  }
}

/// 21 bits an axis: distinct within 2^20 voxels of the origin, which no scan exceeds.
std::uint64_t VoxelKey(const Point& point, float inverse_size) {
  const auto index = [inverse_size](float value) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value * inverse_size))) &
           0x1FFFFFU;
  };
  return index(point.x) << 42U | index(point.y) << 21U | index(point.z);
}

}  // namespace

ros::Time ToRos(Time stamp) {
  constexpr std::int64_t kSecond = 1000000000;
  constexpr std::int64_t kLast = kSecond * std::numeric_limits<std::uint32_t>::max();
  const std::int64_t clamped = std::clamp<std::int64_t>(stamp.nanoseconds(), 0, kLast);
  return ros::Time(static_cast<std::uint32_t>(clamped / kSecond),
                   static_cast<std::uint32_t>(clamped % kSecond));
}

Time FromRos(const ros::Time& stamp) {
  return Time::FromNanoseconds(static_cast<std::int64_t>(stamp.toNSec()));
}

ImuSample FromRos(const sensor_msgs::Imu& message) {
  const auto& w = message.angular_velocity;
  const auto& a = message.linear_acceleration;
  return {FromRos(message.header.stamp), {w.x, w.y, w.z}, {a.x, a.y, a.z}};
}

Pose FromRos(const geometry_msgs::Transform& transform) {
  const auto& q = transform.rotation;
  const auto& t = transform.translation;
  return MakePose(Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized(),
                  Eigen::Vector3d(t.x, t.y, t.z));
}

Pose FromRos(const geometry_msgs::Pose& pose) {
  const auto& q = pose.orientation;
  return MakePose(Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized(),
                  Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z));
}

geometry_msgs::Pose ToPoseMessage(const Pose& pose) {
  const Eigen::Quaterniond rotation(pose.linear());
  geometry_msgs::Pose message;
  message.position.x = pose.translation().x();
  message.position.y = pose.translation().y();
  message.position.z = pose.translation().z();
  message.orientation.x = rotation.x();
  message.orientation.y = rotation.y();
  message.orientation.z = rotation.z();
  message.orientation.w = rotation.w();
  return message;
}

geometry_msgs::Vector3 ToVectorMessage(const Eigen::Vector3d& vector) {
  geometry_msgs::Vector3 message;
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
  return message;
}

geometry_msgs::Point ToPointMessage(const Eigen::Vector3d& point) {
  geometry_msgs::Point message;
  message.x = point.x();
  message.y = point.y();
  message.z = point.z();
  return message;
}

geometry_msgs::Transform ToTransform(const Pose& pose) {
  geometry_msgs::Transform message;
  message.translation = ToVectorMessage(pose.translation());
  message.rotation = ToPoseMessage(pose).orientation;
  return message;
}

void CopyCovariance(const Matrix6d& covariance, boost::array<double, 36>& values) {
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(values.data()) =
      0.5 * (covariance + covariance.transpose());
}

sensor_msgs::PointCloud2Ptr ToCloudMessage(const std::vector<Point>& points) {
  auto cloud = boost::make_shared<sensor_msgs::PointCloud2>();
  SetFields(*cloud);
  cloud->height = 1;
  cloud->width = static_cast<std::uint32_t>(points.size());
  cloud->point_step = kPointStep;
  cloud->row_step = cloud->width * cloud->point_step;
  cloud->is_dense = true;
  cloud->data.resize(points.size() * kPointStep);
  std::uint8_t* to = cloud->data.data();
  for (const Point& point : points) {
    const float values[] = {point.x, point.y, point.z, point.intensity};
    std::memcpy(to, values, kPointStep);
    to += kPointStep;
  }
  return cloud;
}

nav_msgs::OccupancyGrid ToGridMessage(const OccupancyGrid& grid) {
  nav_msgs::OccupancyGrid message;
  message.info.resolution = static_cast<float>(grid.resolution_m);
  message.info.width = static_cast<std::uint32_t>(grid.width);
  message.info.height = static_cast<std::uint32_t>(grid.height);
  message.info.origin.position.x = grid.origin.x();
  message.info.origin.position.y = grid.origin.y();
  message.info.origin.orientation.w = 1.0;
  message.data.assign(grid.cells.begin(), grid.cells.end());
  return message;
}

std::vector<Point> Transformed(const Pose& T_a_b, const std::vector<Point>& points) {
  const Eigen::Isometry3f transform = T_a_b.cast<float>();
  std::vector<Point> moved = points;
  for (Point& point : moved) {
    const Eigen::Vector3f position = transform * Eigen::Vector3f(point.x, point.y, point.z);
    point.x = position.x();
    point.y = position.y();
    point.z = position.z();
  }
  return moved;
}

std::vector<Point> Decimated(const std::vector<Point>& points, double voxel_m) {
  if (voxel_m <= 0.0) return points;
  const auto inverse_size = static_cast<float>(1.0 / voxel_m);
  std::unordered_set<std::uint64_t> taken;
  taken.reserve(points.size());
  std::vector<Point> kept;
  for (const Point& point : points) {
    if (taken.insert(VoxelKey(point, inverse_size)).second) kept.push_back(point);
  }
  return kept;
}

}  // namespace hv
