#pragma once

#include <limits>
#include <string>
#include <vector>

#include "hv_core/config.h"
#include "hv_sim/depth_camera.h"
#include "hv_sim/robot_body.h"
#include "hv_sim/sensor_suite.h"

namespace hv::sim {

/// An obstacle, level and along the axes of the world, that is there for a while.
struct TimedBox {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d size = Eigen::Vector3d::Ones();    ///< [m]
  double from_s = 0.0;
  double until_s = std::numeric_limits<double>::infinity();
};

/// Everything that determines a closed-loop simulation besides the commands.
struct LiveConfig {
  std::string world = "office";  ///< see MakeWorld()
  int seed = 1;                  ///< of clutter, start and every noise
  int world_seed = -1;           ///< of clutter; below 0: as `seed`
  /// x y z [m] yaw [deg] of the base at the start; empty: anywhere free.
  std::vector<double> start;
  /// Obstacles, eight numbers each: centre x y z, size x y z [m], from, until [s].
  std::vector<double> boxes;
  bool lidar_noise = true;
  bool people = true;
  double lidar_dropout = 0.0;   ///< probability that a return is lost
  double point_share = 1.0;     ///< share of LiDAR columns fired, for speed
  double truth_rate_hz = 50.0;  ///< of the true state; 0: none
  RobotBodyConfig robot;
  DepthCameraConfig camera;
  SensorSuiteConfig suite = DefaultSuite("robot");

  /// Seed of the clutter.
  std::uint32_t clutter_seed() const {
    return static_cast<std::uint32_t>(world_seed < 0 ? seed : world_seed);
  }
  std::vector<TimedBox> timed_boxes() const;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

}  // namespace hv::sim
