#pragma once

#include <string>

#include "hv_core/config.h"
#include "hv_core/point_cloud_decoder.h"
#include "hv_lio/lio_config.h"

namespace hv::lio {

/// Where the data come from: topic names in a bag and on the robot alike.
struct InputConfig {
  std::string points_topic = "points";
  std::string imu_topic = "imu";

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// What the node publishes and under which frame names.
struct OutputConfig {
  std::string odom_frame = "odom";
  std::string base_frame = "base_link";
  std::string imu_frame = "imu_link";
  std::string lidar_frame = "";
  bool publish_tf = true;
  bool extrinsic_from_tf = false;
  double cloud_voxel_m = 0.0;
  double path_min_distance_m = 0.1;
  int path_max_poses = 20000;
  double voxels_period_s = 2.0;
  int voxels_max = 20000;
  double keyframe_distance_m = 0.5;
  double keyframe_angle_deg = 20.0;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// The configuration file of odometry, offline and online: sections `input`, `points`,
/// `odometry`, `output`.
struct SystemConfig {
  InputConfig input;
  PointCloudDecoderConfig points;
  LioConfig odometry;
  OutputConfig output;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

}  // namespace hv::lio
