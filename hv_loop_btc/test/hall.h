#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "hv_core/scan.h"
#include "simulated_room.h"

namespace hv::loop {

/// A hall with cupboards, pillars and a ring around the middle to walk on, seen by a LiDAR of 32
/// rings. Sizes and places follow from the seed.
class Hall {
 public:
  explicit Hall(unsigned seed) {
    std::mt19937 random(seed);
    const auto between = [&random](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    const Eigen::Vector2d half(between(7.5, 9.0), between(6.0, 7.0));
    walls_ = {{-half.x(), -half.y(), 0.0}, {half.x(), half.y(), between(2.8, 3.4)}};
    while (boxes_.size() < 16) {
      const Eigen::Vector2d place(between(-half.x(), half.x()), between(-half.y(), half.y()));
      const bool on_ring = place.norm() > 2.2 && place.norm() < 6.4;
      const double reach = between(0.15, 0.8);
      if (on_ring) continue;
      boxes_.push_back({{place.x() - reach, place.y() - between(0.15, 0.8), 0.0},
                        {place.x() + between(0.15, 0.8), place.y() + reach, between(0.5, 3.0)}});
    }
  }

  /// One scan with noise, in the frame of the sensor.
  std::vector<Point> Scan(const Pose& T_hall_sensor, std::mt19937& random) const {
    constexpr int kColumns = 450;
    constexpr int kRings = 32;
    std::normal_distribution<double> noise(0.0, 0.01);
    const double turn = std::uniform_real_distribution<double>(0.0, 1.0)(random);
    std::vector<Point> points;
    for (int column = 0; column < kColumns; ++column) {
      const double azimuth = 2.0 * M_PI * (column + turn) / kColumns;
      for (int ring = 0; ring < kRings; ++ring) {
        const double elevation = (11.0 - ring) * M_PI / 180.0;
        const Eigen::Vector3d beam(std::cos(elevation) * std::cos(azimuth),
                                   std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        const double range = Range(T_hall_sensor, beam) + noise(random);
        const Eigen::Vector3f point = (range * beam).cast<float>();
        points.push_back({point.x(), point.y(), point.z(), 9.0F, 0.0F, 0});
      }
    }
    return points;
  }

 private:
  double Range(const Pose& T_hall_sensor, const Eigen::Vector3d& beam) const {
    const Eigen::Vector3d origin = T_hall_sensor.translation();
    const Eigen::Vector3d direction = T_hall_sensor.linear() * beam;
    double nearest = walls_.Cast(origin, direction);
    for (const Box& box : boxes_) nearest = std::min(nearest, box.Cast(origin, direction));
    return nearest;
  }

  Box walls_;
  std::vector<Box> boxes_;
};

}  // namespace hv::loop
