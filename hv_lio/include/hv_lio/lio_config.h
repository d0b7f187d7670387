#pragma once

#include <string>
#include <vector>

#include "hv_core/config.h"
#include "hv_core/se3.h"
#include "hv_lio/constant_velocity.h"
#include "hv_lio/initializer.h"
#include "hv_lio/imu_propagation.h"
#include "hv_lio/scan_preprocessor.h"
#include "hv_lio/scan_update.h"
#include "hv_lio/voxel_map.h"

namespace hv::lio {

/// Pose of the LiDAR in the IMU frame, T_imu_lidar: p_imu = T_imu_lidar * p_lidar.
struct ExtrinsicConfig {
  std::vector<double> translation_m{0.0, 0.0, 0.0};
  std::vector<double> rotation_xyzw{0.0, 0.0, 0.0, 1.0};

  Pose T_imu_lidar() const;
  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// How the pipeline treats disturbed input.
struct RobustnessConfig {
  double imu_gap_s = 0.05;
  double clock_jump_s = 1.0;
  std::string on_clock_jump = "continue";
  int max_waiting_scans = 20;
  double max_speed_mps = 60.0;
  int max_imu_only_scans = 50;
  double misfit_share = 0.5;
  double misfit_ratio = 4.0;
  int misfit_scans = 10;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Everything the odometry can be told. One struct for the offline tool and the node.
struct LioConfig {
  bool use_imu = true;
  int threads = 1;
  double lidar_time_offset_s = 0.0;
  ExtrinsicConfig extrinsic;
  ImuNoiseConfig imu;
  InitializerConfig initialization;
  ConstantVelocityConfig constant_velocity;
  PreprocessConfig preprocess;
  VoxelMapConfig map;
  UpdateConfig update;
  RobustnessConfig robustness;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

}  // namespace hv::lio
