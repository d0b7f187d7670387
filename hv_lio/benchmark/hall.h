#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "hv_core/scan.h"
#include "hv_core/se3.h"

namespace hv::lio {

/// A hall of 30 x 20 x 5 m with pillars, scanned as a PandarXT-32 does: 2000 columns of 32 rings in
/// 0.1 s. The LiDAR moves ahead at 1 m/s while it turns at 0.5 rad/s.
class Hall {
 public:
  /// Pose of the LiDAR `time` seconds after the start.
  static Pose PoseAt(double time) {
    return MakePose(RotationFromRpy(0.0, 0.0, 0.5 * time), Eigen::Vector3d(time, 0.0, 0.0));
  }

  /// The sweep that starts `start` seconds after the start, with 1 cm of range noise.
  Scan Sweep(double start) {
    std::normal_distribution<double> noise(0.0, 0.01);
    Scan scan;
    scan.stamp = Time::FromSeconds(1000.0 + start);
    for (int column = 0; column < 2000; ++column) {
      const double time = 50e-6 * column;
      const Pose pose = PoseAt(start + time);
      const double azimuth = 2.0 * M_PI * column / 2000.0;
      for (int ring = 0; ring < 32; ++ring) {
        const double elevation = (15.0 - ring) * M_PI / 180.0;
        const Eigen::Vector3d beam(std::cos(elevation) * std::cos(azimuth),
                                   std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        const double range = Cast(pose.translation(), pose.linear() * beam) + noise(random_);
        const Eigen::Vector3f point = (range * beam).cast<float>();
        scan.points.push_back({point.x(), point.y(), point.z(), 10.0F, static_cast<float>(time),
                               static_cast<std::uint16_t>(ring)});
      }
    }
    scan.duration = scan.points.back().time;
    return scan;
  }

 private:
  static double Cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& beam) {
    const Eigen::Vector3d low(-15.0, -10.0, -1.5);
    const Eigen::Vector3d high(15.0, 10.0, 3.5);
    double nearest = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(beam[axis]) < 1e-12) continue;
      const double wall = beam[axis] > 0.0 ? high[axis] : low[axis];
      nearest = std::min(nearest, (wall - origin[axis]) / beam[axis]);
    }
    for (int i = -2; i <= 2; ++i) {
      for (const double y : {-5.0, 5.0}) {
        nearest = std::min(nearest, CastPillar(origin, beam, Eigen::Vector2d(5.0 * i, y)));
      }
    }
    return nearest;
  }

  /// Distance to an upright cylinder of 0.4 m radius, infinite when the beam passes it.
  static double CastPillar(const Eigen::Vector3d& origin, const Eigen::Vector3d& beam,
                           const Eigen::Vector2d& center) {
    const Eigen::Vector2d offset = origin.head<2>() - center;
    const double a = beam.head<2>().squaredNorm();
    const double b = offset.dot(beam.head<2>());
    const double c = offset.squaredNorm() - 0.16;
    const double root = b * b - a * c;
    const double distance = root > 0.0 ? (-b - std::sqrt(root)) / a : -1.0;
    return distance > 0.0 ? distance : std::numeric_limits<double>::infinity();
  }

  std::mt19937 random_{11};
};

}  // namespace hv::lio
