#include "hv_ros/message_checks.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>

namespace hv {
namespace {

using sensor_msgs::PointCloud2;
using sensor_msgs::PointField;

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

/// Whether a pose of unit quaternion turns nothing about any axis.
bool IsUpright(const geometry_msgs::Pose& pose) {
  constexpr double kTolerance = 1e-6;
  const auto& q = pose.orientation;
  return Eigen::Vector3d(q.x, q.y, q.z).norm() < kTolerance;
}

}  // namespace

bool IsPose(const geometry_msgs::Pose& pose) {
  constexpr double kTolerance = 1e-3;
  const auto& q = pose.orientation;
  const double norm = Eigen::Vector4d(q.x, q.y, q.z, q.w).norm();
  return ToVector(pose.position).allFinite() && std::abs(norm - 1.0) < kTolerance;
}

std::string ReadPoints(const PointCloud2& cloud, std::vector<Point>& points) {
  const auto x = OffsetOf(cloud, "x");
  const auto y = OffsetOf(cloud, "y");
  const auto z = OffsetOf(cloud, "z");
  const auto intensity = OffsetOf(cloud, "intensity");
  if (!x || !y || !z) return "its cloud has no float32 fields x, y, z";
  if (cloud.is_bigendian != 0 || !SizesAgree(cloud)) return "sizes of its cloud contradict";
  if (cloud.width == 0) return "";  // of any number of rows
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

std::string ReadGrid(const nav_msgs::OccupancyGrid& message, OccupancyGrid& grid) {
  constexpr std::uint32_t kLongest = 20000;  // cells of a side
  const auto& info = message.info;
  if (!(info.resolution > 0.0F) || !std::isfinite(info.resolution)) {
    return "the resolution of the grid is not positive";
  }
  if (info.width == 0 || info.height == 0) return "the grid is empty";
  const bool fits = info.width <= kLongest && info.height <= kLongest &&
                    message.data.size() == std::size_t{info.width} * info.height;
  if (!fits) return "sizes of the grid contradict or are too large";
  if (!IsPose(info.origin)) return "the origin of the grid is not a finite pose";
  if (!IsUpright(info.origin)) return "the grid is turned";
  grid.resolution_m = static_cast<double>(info.resolution);
  grid.origin = ToVector(info.origin.position).head<2>();
  grid.width = static_cast<int>(info.width);
  grid.height = static_cast<int>(info.height);
  grid.cells.assign(message.data.begin(), message.data.end());
  return "";
}

}  // namespace hv
