#include "hv_lio/system_config.h"

namespace hv::lio {

void InputConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("points_topic", points_topic, "topic of the point clouds");
  visitor.Field("imu_topic", imu_topic, "topic of the IMU");
}

void InputConfig::Validate(ConfigProblems& problems) const {
  problems.Require(!points_topic.empty(), "input.points_topic", "must not be empty");
  problems.Require(!imu_topic.empty(), "input.imu_topic", "must not be empty");
}

void OutputConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("odom_frame", odom_frame, "fixed frame of the odometry");
  visitor.Field("base_frame", base_frame, "frame whose pose is published");
  visitor.Field("imu_frame", imu_frame, "frame of the IMU");
  visitor.Field("lidar_frame", lidar_frame, "frame of the LiDAR; empty: as in the clouds");
  visitor.Field("publish_tf", publish_tf, "publish odom -> base on /tf");
  visitor.Field("extrinsic_from_tf", extrinsic_from_tf,
                "take T_imu_lidar from tf instead of the configuration");
  visitor.Field("cloud_voxel_m", cloud_voxel_m,
                "grid of the published registered cloud; 0 = every point [m]");
  visitor.Field("path_min_distance_m", path_min_distance_m, "spacing of the published path [m]");
  visitor.Field("path_max_poses", path_max_poses, "longest published path [poses]");
  visitor.Field("voxels_period_s", voxels_period_s, "period of the voxel markers [s]");
  visitor.Field("voxels_max", voxels_max, "most voxel markers in one message");
  visitor.Field("keyframe_distance_m", keyframe_distance_m, "distance between keyframes [m]");
  visitor.Field("keyframe_angle_deg", keyframe_angle_deg, "angle between keyframes [deg]");
}

void OutputConfig::Validate(ConfigProblems& problems) const {
  problems.Require(!odom_frame.empty(), "output.odom_frame", "must not be empty");
  problems.Require(!base_frame.empty(), "output.base_frame", "must not be empty");
  problems.Require(odom_frame != base_frame, "output.base_frame", "must differ from odom_frame");
  problems.Require(cloud_voxel_m >= 0.0, "output.cloud_voxel_m", "must not be negative");
  problems.Require(path_min_distance_m >= 0.0, "output.path_min_distance_m",
                   "must not be negative");
  problems.Require(path_max_poses >= 2, "output.path_max_poses", "must be at least 2");
  problems.Require(voxels_period_s > 0.0, "output.voxels_period_s", "must be positive");
  problems.Require(voxels_max >= 1, "output.voxels_max", "must be at least 1");
  problems.Require(keyframe_distance_m > 0.0, "output.keyframe_distance_m", "must be positive");
  problems.Require(keyframe_angle_deg > 0.0, "output.keyframe_angle_deg", "must be positive");
}

void SystemConfig::Describe(ConfigVisitor& visitor) {
  visitor.Section("input", input, "topics");
  visitor.Section("points", points, "decoding of point clouds");
  visitor.Section("odometry", odometry, "LiDAR-inertial odometry");
  visitor.Section("output", output, "what the node publishes");
  visitor.Foreign("loop");
  visitor.Foreign("map");
  visitor.Foreign("mapping");
  visitor.Foreign("localization");
  visitor.Foreign("navigation");
  visitor.Foreign("exploration");
}

void SystemConfig::Validate(ConfigProblems& problems) const {
  input.Validate(problems);
  points.Validate(problems);
  odometry.Validate(problems);
  output.Validate(problems);
}

}  // namespace hv::lio
