#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "hv_core/scan.h"
#include "hv_core/se3.h"

namespace hv::lio {

/// The inside of an axis-aligned box with a few pillars, scanned by an ideal spinning LiDAR: small
/// enough to compute in a test, exact enough to check millimetres.
struct BoxRoom {
  Eigen::Vector3d low{-6.0, -4.0, -1.0};
  Eigen::Vector3d high{7.0, 5.0, 2.5};

  /// Distance from `origin` along the unit vector `beam` to the wall.
  double Cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& beam) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(beam[axis]) < 1e-12) continue;
      const double wall = beam[axis] > 0.0 ? high[axis] : low[axis];
      nearest = std::min(nearest, (wall - origin[axis]) / beam[axis]);
    }
    return nearest;
  }

  /// One 0.1 s sweep of 16 rings that starts at `start`; `T_room_lidar(t)` is the pose at absolute
  /// time t. `sigma` is the range noise [m].
  Scan Sweep(double start, const std::function<Pose(double)>& T_room_lidar, double sigma,
             std::mt19937& random) const {
    constexpr int kColumns = 360;
    constexpr int kRings = 16;
    std::normal_distribution<double> noise(0.0, 1.0);
    Scan scan;
    scan.stamp = Time::FromSeconds(start);
    for (int column = 0; column < kColumns; ++column) {
      const double time = 0.1 * column / kColumns;
      const Pose pose = T_room_lidar(start + time);
      const double azimuth = 2.0 * M_PI * column / kColumns;
      for (int ring = 0; ring < kRings; ++ring) {
        const double elevation = (ring - 7.5) * 3.0 * M_PI / 180.0;
        const Eigen::Vector3d beam(std::cos(elevation) * std::cos(azimuth),
                                   std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        const double range =
            Cast(pose.translation(), pose.linear() * beam) + sigma * noise(random);
        const Eigen::Vector3f point = (range * beam).cast<float>();
        scan.points.push_back({point.x(), point.y(), point.z(), 1.0F, static_cast<float>(time),
                               static_cast<std::uint16_t>(ring)});
      }
    }
    scan.duration = scan.points.back().time;
    return scan;
  }
};

}  // namespace hv::lio
