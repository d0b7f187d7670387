#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hv_core/imu_sample.h"
#include "hv_core/scan.h"
#include "hv_core/se3.h"
#include "hv_navigation/planar.h"
#include "hv_replay/slam_config.h"
#include "hv_sim/live_simulation.h"
#include "hv_sim/sensor_suite.h"

namespace hv::replay {

/// What is known about where the robot is.
struct RobotPlace {
  Time stamp;
  Pose T_odom_base = Pose::Identity();
  Pose T_map_odom = Pose::Identity();
  bool localized = false;  ///< whether T_map_odom can be trusted
  navigation::Velocity velocity;
};

/// A scan free of distortion.
struct LocatedScan {
  Time stamp;                 ///< its end
  std::vector<Point> points;  ///< in the frame of the LiDAR at the end [m]
  Pose T_odom_base = Pose::Identity();
  std::uint32_t segment = 0;  ///< odometry of different segments is not connected
};

/// Tells where a simulated robot is, by its sensors or by the truth. Takes what LiveSimulation says
/// in order of time. Not thread-safe.
class RobotLocator {
 public:
  virtual ~RobotLocator() = default;

  virtual void AddImu(const ImuSample& sample) = 0;
  virtual void AddTruth(const sim::TrueState& state) = 0;
  virtual void AddScan(Scan scan) = 0;

  /// The next scan whose place is known; call until it gives nullopt.
  virtual std::optional<LocatedScan> NextScan() = 0;

  /// At a time in the last second; nullopt before there is odometry.
  virtual std::optional<RobotPlace> At(Time stamp) const = 0;
};

/// By odometry and, with a `map`, localisation in it, as the nodes do it; without one the map is
/// the frame of odometry. `T_map_base` is about where the robot is at first, as an operator tells
/// it; without, it is looked for anywhere. Throws InputError when the map cannot be read.
std::unique_ptr<RobotLocator> LocateBySensors(const SlamConfig& config, const std::string& map,
                                              const sim::SensorRig& rig,
                                              const std::optional<Pose>& T_map_base = std::nullopt);

/// By the true states, which have to come with each IMU sample. Its frame of odometry is the world.
std::unique_ptr<RobotLocator> LocateByTruth(const Pose& T_map_world, const sim::SensorRig& rig);

}  // namespace hv::replay
