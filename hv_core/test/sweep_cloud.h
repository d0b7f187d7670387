#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "hv_core/point_cloud_decoder.h"

/// Packed clouds for the tests of the decoder.
namespace hv {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr std::int64_t kEpochNs = 1646310000123456789;
inline constexpr int kColumns = 500;
inline constexpr int kRings = 32;
inline constexpr double kColumnPeriod = 0.1 / kColumns;

inline double FiringTime(int column, int ring) { return column * kColumnPeriod + ring * 1.5e-6; }
inline constexpr double kLastFiring = (kColumns - 1) * (0.1 / kColumns) + (kRings - 1) * 1.5e-6;

/// Owns the bytes of a cloud and writes fields into them.
struct Cloud {
  std::vector<std::uint8_t> bytes;
  PointCloudView view;

  Cloud(std::uint32_t width, std::uint32_t height, std::uint32_t point_step)
      : bytes(std::size_t{width} * height * point_step) {
    view.stamp = Time::FromNanoseconds(kEpochNs);
    view.width = width;
    view.height = height;
    view.point_step = point_step;
    view.row_step = width * point_step;
    view.data = bytes.data();
    view.size = bytes.size();
  }

  template <typename T>
  void Put(std::size_t point, std::uint32_t offset, T value) {
    std::memcpy(bytes.data() + point * view.point_step + offset, &value, sizeof(T));
  }

  void PutXyz(std::size_t point, float x, float y, float z) {
    Put(point, 0, x);
    Put(point, 4, y);
    Put(point, 8, z);
  }
};

/// A sweep in firing order, seen clockwise from above; `time_value` turns the firing time [s] after
/// the first point into the driver's value.
template <typename T>
Cloud Sweep(const std::string& time_name, FieldType type, std::function<T(double)> time_value) {
  Cloud cloud(kColumns * kRings, 1, 26);
  cloud.view.fields = {{"x", 0, FieldType::kFloat32}, {"y", 4, FieldType::kFloat32},
                       {"z", 8, FieldType::kFloat32}, {"intensity", 12, FieldType::kFloat32},
                       {time_name, 16, type},         {"ring", 24, FieldType::kUint16}};
  std::size_t index = 0;
  for (int column = 0; column < kColumns; ++column) {
    const double azimuth = 1.0 - 2.0 * kPi * column / kColumns;
    for (int ring = 0; ring < kRings; ++ring, ++index) {
      const float range = 5.0F + static_cast<float>(ring);
      cloud.PutXyz(index, range * static_cast<float>(std::cos(azimuth)),
                   range * static_cast<float>(std::sin(azimuth)), 0.1F * static_cast<float>(ring));
      cloud.Put(index, 12, static_cast<float>(ring) * 2.0F);
      cloud.Put(index, 16, time_value(FiringTime(column, ring)));
      cloud.Put(index, 24, static_cast<std::uint16_t>(ring));
    }
  }
  return cloud;
}

inline const Time kStart = Time::FromNanoseconds(kEpochNs);

}  // namespace hv
