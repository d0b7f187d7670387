#pragma once

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "hv_core/scan.h"
#include "hv_core/se3.h"

namespace hv::navigation {

/// Convex solids to cast rays at, in the frame of odometry.
class SolidScene {
 public:
  using Vector3d = Eigen::Vector3d;

  struct Plane {
    Vector3d normal;  ///< outwards
    double offset;    ///< inside: normal . x <= offset
  };
  using Solid = std::vector<Plane>;

  void AddBox(const Vector3d& low, const Vector3d& high) {
    Solid solid;
    for (int axis = 0; axis < 3; ++axis) {
      solid.push_back({Vector3d::Unit(axis), high[axis]});
      solid.push_back({-Vector3d::Unit(axis), -low[axis]});
    }
    solids_.push_back(solid);
  }

  /// Everything below z = height for |y| below a half width, between two x.
  void AddFloor(double from_x, double to_x, double height = 0.0) {
    AddBox({from_x, -30.0, height - 1.0}, {to_x, 30.0, height});
  }

  /// Below the plane that rises by `slope` along x, from the floor at `from_x` to `to_x`.
  void AddRamp(double from_x, double to_x, double slope, double half_width = 30.0) {
    Solid solid;
    const Vector3d up(-slope, 0.0, 1.0);
    solid.push_back({up, -slope * from_x});
    solid.push_back({-Vector3d::UnitX(), -from_x});
    solid.push_back({Vector3d::UnitX(), to_x});
    solid.push_back({Vector3d::UnitY(), half_width});
    solid.push_back({-Vector3d::UnitY(), half_width});
    solid.push_back({-Vector3d::UnitZ(), 1.0});
    solids_.push_back(solid);
  }

  void RemoveLast() { solids_.pop_back(); }

  /// Range along the unit `direction`; infinite when nothing is met.
  double Cast(const Vector3d& origin, const Vector3d& direction) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Solid& solid : solids_) nearest = std::min(nearest, Enter(solid, origin, direction));
    return nearest;
  }

  /// 32 rings from -16 to 15 degrees, in the frame of the sensor.
  std::vector<Point> LidarScan(const Pose& T_odom_lidar, double step_deg, double sigma_m,
                               unsigned seed) const {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, sigma_m);
    std::vector<Point> points;
    const auto columns = static_cast<int>(360.0 / step_deg);
    for (int column = 0; column < columns; ++column) {
      for (int ring = -16; ring <= 15; ++ring) {
        const double elevation = ring * M_PI / 180.0;
        const double azimuth = column * step_deg * M_PI / 180.0;
        const Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                           std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        AddReturn(T_odom_lidar, ray, 60.0, sigma_m > 0.0 ? noise(random) : 0.0, points);
      }
    }
    return points;
  }

  /// Points of a depth camera (x right, y down, z forward) of 86 x 58 degrees, one a degree times
  /// `step_deg`.
  std::vector<Point> DepthPoints(const Pose& T_odom_camera, double step_deg) const {
    std::vector<Point> points;
    for (double v = -29.0; v <= 29.0; v += step_deg) {
      for (double u = -43.0; u <= 43.0; u += step_deg) {
        const Vector3d ray(std::tan(u * M_PI / 180.0), std::tan(v * M_PI / 180.0), 1.0);
        AddReturn(T_odom_camera, ray.normalized(), 6.0, 0.0, points);
      }
    }
    return points;
  }

 private:
  static double Enter(const Solid& solid, const Vector3d& origin, const Vector3d& direction) {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    double enter = 0.0;
    double leave = kNever;
    for (const Plane& plane : solid) {
      const double inside = plane.offset - plane.normal.dot(origin);
      const double speed = plane.normal.dot(direction);
      if (std::abs(speed) < 1e-12) {
        if (inside < 0.0) return kNever;
      } else if (speed < 0.0) {
        enter = std::max(enter, inside / speed);
      } else {
        leave = std::min(leave, inside / speed);
      }
    }
    return enter < leave && enter > 0.0 ? enter : kNever;
  }

  void AddReturn(const Pose& T_odom_sensor, const Vector3d& ray, double limit_m, double noise_m,
                 std::vector<Point>& points) const {
    const double range = Cast(T_odom_sensor.translation(), T_odom_sensor.linear() * ray);
    if (!(range < limit_m)) return;
    const Eigen::Vector3f at = ((range + noise_m) * ray).cast<float>();
    Point point;
    point.x = at.x();
    point.y = at.y();
    point.z = at.z();
    points.push_back(point);
  }

  std::vector<Solid> solids_;
};

/// A camera at a height that looks along x, tilted down.
inline Pose CameraPose(double x, double height, double down_deg) {
  Eigen::Matrix3d axes;  // columns: right, down, forward
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return MakePose(RotationFromRpy(0.0, down_deg * M_PI / 180.0, 0.0) * axes,
                  Eigen::Vector3d(x, 0.0, height));
}

}  // namespace hv::navigation
