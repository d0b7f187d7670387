#pragma once

#include "hv_replay/slam_config.h"
#include "hv_sim/sensor_suite.h"

namespace hv::replay {

/// The configuration of the simulated robot, for one thread.
inline SlamConfig SimulatedRobot() {
  const Pose T_imu_lidar = sim::MakeRig(sim::DefaultSuite("robot")).T_imu_lidar();
  const Eigen::Vector3d& t = T_imu_lidar.translation();
  const Eigen::Quaterniond q(T_imu_lidar.linear());
  SlamConfig config;
  config.system.odometry.extrinsic.translation_m = {t.x(), t.y(), t.z()};
  config.system.odometry.extrinsic.rotation_xyzw = {q.x(), q.y(), q.z(), q.w()};
  config.system.odometry.threads = 1;
  return config;
}

}  // namespace hv::replay
