#pragma once

#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Core>

#include "hall.h"
#include "hv_core/angles.h"
#include "hv_core/se3.h"

namespace hv::relocalize {

/// One scan of a hall with noise, in the frame of the sensor.
inline std::vector<Eigen::Vector3f> ScanOf(const loop::Hall& hall, const Pose& T_hall_sensor,
                                           std::mt19937& random) {
  std::vector<Eigen::Vector3f> points;
  for (const Point& point : hall.Scan(T_hall_sensor, random)) {
    points.emplace_back(point.x, point.y, point.z);
  }
  return points;
}

/// A pose on the free ring around the middle of a hall.
inline Pose OnRing(double angle, double radius, double yaw, double roll = 0.0, double pitch = 0.0) {
  return MakePose(RotationFromRpy(roll, pitch, yaw),
                  {radius * std::cos(angle), radius * std::sin(angle), 1.1});
}

/// Anywhere on the ring, at any heading, tilted by up to 3 deg.
inline Pose RandomOnRing(std::mt19937& random) {
  std::uniform_real_distribution<double> angle(-M_PI, M_PI);
  std::uniform_real_distribution<double> radius(3.6, 5.0);
  std::uniform_real_distribution<double> tilt(-3.0 * kRadiansPerDegree, 3.0 * kRadiansPerDegree);
  const double place = angle(random);
  const double out = radius(random);
  const double yaw = angle(random);
  const double roll = tilt(random);
  return OnRing(place, out, yaw, roll, tilt(random));
}

/// The cloud of a hall from scans all around the ring, in the frame of the hall.
inline std::vector<Eigen::Vector3f> CloudOf(const loop::Hall& hall, std::mt19937& random) {
  constexpr int kScans = 10;
  std::vector<Eigen::Vector3f> cloud;
  for (int i = 0; i < kScans; ++i) {
    const Pose pose = OnRing(2.0 * M_PI * i / kScans, 4.3, 0.7 * i);
    const Eigen::Isometry3f T_hall_sensor = pose.cast<float>();
    for (const Eigen::Vector3f& point : ScanOf(hall, pose, random)) {
      cloud.push_back(T_hall_sensor * point);
    }
  }
  return cloud;
}

}  // namespace hv::relocalize
