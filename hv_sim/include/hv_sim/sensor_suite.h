#pragma once

#include <string>
#include <vector>

#include "hv_core/config.h"
#include "hv_core/se3.h"
#include "hv_sim/imu_simulator.h"
#include "hv_sim/lidar.h"

namespace hv::sim {

/// Which sensors are carried, and where. `base` is the reference frame of a data set (base_link of
/// a robot, the z-down body of NCLT, the IMU itself of Hilti).
struct SensorSuiteConfig {
  std::string lidar = "pandar_xt32";  ///< or hdl_32e
  double epoch_s = 1646310000.0;      ///< sensor clock at the start of the trajectory [s]
  double first_scan_s = 0.02;         ///< start of the first revolution [s]
  /// Poses of the sensors in the base frame: x y z [m] qx qy qz qw.
  std::vector<double> T_base_imu = {0, 0, 0, 0, 0, 0, 1};
  std::vector<double> T_base_lidar = {0, 0, 0, 0, 0, 0, 1};
  /// Attitude of the base frame in the carrier (x forward, z up): roll pitch yaw [deg].
  std::vector<double> base_rpy_deg = {0, 0, 0};
  ImuConfig imu;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// hilti, nclt, robot.
std::vector<std::string> FormatNames();

/// The sensors of a data format. Throws InputError for an unknown format.
SensorSuiteConfig DefaultSuite(const std::string& format);

/// The same, as transforms. The LiDAR sits at the origin of the body whose motion is simulated.
struct SensorRig {
  Pose T_body_base = Pose::Identity();
  Pose T_base_imu = Pose::Identity();
  Pose T_base_lidar = Pose::Identity();

  Pose T_body_imu() const { return T_body_base * T_base_imu; }
  Pose T_body_lidar() const { return T_body_base * T_base_lidar; }
  Pose T_imu_lidar() const { return T_base_imu.inverse() * T_base_lidar; }
};

SensorRig MakeRig(const SensorSuiteConfig& suite);

/// Throws InputError for an unknown LiDAR.
LidarModel MakeLidarModel(const SensorSuiteConfig& suite);

}  // namespace hv::sim
