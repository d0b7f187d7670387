#include "sensor_messages.h"

#include <cmath>
#include <cstring>

#include "hv_ros/conversions.h"

namespace hv::sim {
namespace {

constexpr std::uint32_t kPointStep = 48;
constexpr std::size_t kIntensityOffset = 16;
constexpr std::size_t kTimestampOffset = 24;
constexpr std::size_t kRingOffset = 32;

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

}  // namespace

sensor_msgs::PointCloud2 ToHesaiCloud(const Scan& scan) {
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

sensor_msgs::Imu ToImuMessage(const ImuSample& sample, const ImuConfig& config) {
  sensor_msgs::Imu imu;
  imu.orientation.w = 1.0;
  imu.orientation_covariance[0] = -1.0;
  imu.angular_velocity = ToVectorMessage(sample.angular_velocity);
  imu.linear_acceleration = ToVectorMessage(sample.acceleration);
  for (const std::size_t diagonal : {0U, 4U, 8U}) {
    imu.angular_velocity_covariance[diagonal] =
        config.gyro_noise * config.gyro_noise * config.rate_hz;
    imu.linear_acceleration_covariance[diagonal] =
        config.accel_noise * config.accel_noise * config.rate_hz;
  }
  return imu;
}

}  // namespace hv::sim
