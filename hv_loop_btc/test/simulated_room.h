#pragma once

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "hv_core/point_cloud_file.h"
#include "hv_core/pose_graph_data.h"

namespace hv::loop {

/// Axis-aligned box.
struct Box {
  Eigen::Vector3d low;
  Eigen::Vector3d high;

  /// Distance along the ray to its surface from outside, or from inside; infinity without.
  double Cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& beam) const {
    double enter = -std::numeric_limits<double>::infinity();
    double leave = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (low[axis] - origin[axis]) / beam[axis];
      const double b = (high[axis] - origin[axis]) / beam[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (leave < std::max(enter, 0.0)) return std::numeric_limits<double>::infinity();
    return enter > 0.0 ? enter : leave;
  }

  /// Distance of a point to the surface.
  double Distance(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d outside = (low - p).cwiseMax(p - high);
    return outside.maxCoeff() > 0.0 ? outside.cwiseMax(0.0).norm() : -outside.maxCoeff();
  }
};

/// A furnished room with a floor at z = 0, and a walker, seen by a 32-channel LiDAR.
struct SimulatedRoom {
  Box room{{-8.0, -5.0, 0.0}, {8.0, 5.0, 3.0}};
  std::vector<Box> furniture{{{-2.0, -4.9, 0.0}, {-0.5, -4.2, 0.8}},   // chest
                             {{2.0, 1.0, 0.0}, {2.4, 1.4, 3.0}},       // pillar
                             {{-6.0, 3.0, 0.68}, {-4.4, 3.8, 0.74}},   // table top
                             {{-6.0, 3.0, 0.0}, {-5.92, 3.08, 0.68}},  // and legs
                             {{-4.48, 3.72, 0.0}, {-4.4, 3.8, 0.68}},
                             {{5.0, -5.0, 0.0}, {5.05, -2.0, 2.0}}};  // screen
  double sigma = 0.01;                                                ///< of ranges [m]
  double sensor_height = 0.8;

  /// The walker at keyframe `i`, up and down across the room.
  static Box Walker(int i) {
    const double phase = 0.55 * i;
    const double y = 3.5 * std::sin(0.35 * phase);
    const double x = 4.0 - 0.25 * i;
    return {{x - 0.2, y - 0.25, 0.0}, {x + 0.2, y + 0.25, 1.75}};
  }

  /// The sensor at keyframe `i`: a loop around the middle.
  Pose SensorAt(int i) const {
    const double angle = 0.21 * i;
    const Eigen::Vector3d position(4.5 * std::cos(angle), 2.6 * std::sin(angle), sensor_height);
    return MakePose(RotationFromRpy(0.02 * std::sin(angle), -0.02, angle + 1.5), position);
  }

  double DistanceToStatic(const Eigen::Vector3d& p) const {
    double nearest = room.Distance(p);
    for (const Box& box : furniture) nearest = std::min(nearest, box.Distance(p));
    return nearest;
  }

  /// Points in the sensor frame; thinned as the keyframe store does it.
  PointCloud Scan(int i, bool with_walker, std::mt19937& random) const {
    std::normal_distribution<double> noise(0.0, sigma);
    const Pose pose = SensorAt(i);
    PointCloud cloud;
    for (int column = 0; column < 1000; ++column) {
      for (int ring = 0; ring < 32; ++ring) {
        const double azimuth = 2.0 * M_PI * (column + 0.01 * i) / 1000.0;
        const double elevation = (15.0 - ring) * M_PI / 180.0;
        const Eigen::Vector3d beam(std::cos(elevation) * std::cos(azimuth),
                                   std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        const double range =
            Cast(pose.translation(), pose.linear() * beam, with_walker ? i : -1) + noise(random);
        const Eigen::Vector3f point = (range * beam).cast<float>();
        cloud.points.push_back({point.x(), point.y(), point.z(), 9.0F, 0.0F, 0});
      }
    }
    cloud.points = ThinPoints(cloud.points, 0.1);
    return cloud;
  }

  std::vector<GraphVertex> Vertices(int count) const {
    std::vector<GraphVertex> vertices;
    for (int i = 0; i < count; ++i) {
      vertices.push_back({static_cast<std::uint32_t>(i), Time(), SensorAt(i)});
    }
    return vertices;
  }

 private:
  double Cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& beam, int walker) const {
    double nearest = room.Cast(origin, beam);
    for (const Box& box : furniture) nearest = std::min(nearest, box.Cast(origin, beam));
    if (walker >= 0) nearest = std::min(nearest, Walker(walker).Cast(origin, beam));
    return nearest;
  }
};

}  // namespace hv::loop
