#include "hv_lio/lio_config.h"

#include <cmath>

namespace hv::lio {

Pose ExtrinsicConfig::T_imu_lidar() const {
  const Eigen::Quaterniond rotation(rotation_xyzw[3], rotation_xyzw[0], rotation_xyzw[1],
                                    rotation_xyzw[2]);
  return MakePose(rotation, Eigen::Vector3d(translation_m[0], translation_m[1], translation_m[2]));
}

void ExtrinsicConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("translation_m", translation_m, "position of the LiDAR in the IMU frame [m]");
  visitor.Field("rotation_xyzw", rotation_xyzw,
                "rotation of the LiDAR in the IMU frame, quaternion x y z w");
}

void ExtrinsicConfig::Validate(ConfigProblems& problems) const {
  problems.Require(translation_m.size() == 3, "extrinsic.translation_m", "needs 3 numbers");
  problems.Require(rotation_xyzw.size() == 4, "extrinsic.rotation_xyzw", "needs 4 numbers");
  double squares = 0.0;
  for (const double value : rotation_xyzw) squares += value * value;
  problems.Require(std::abs(squares - 1.0) < 1e-3, "extrinsic.rotation_xyzw",
                   "must be a unit quaternion");
}

void RobustnessConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("imu_gap_s", imu_gap_s,
                "silence of the IMU that is bridged with growing uncertainty [s]");
  visitor.Field("clock_jump_s", clock_jump_s, "step of the stamps that counts as a jump [s]");
  visitor.Field("on_clock_jump", on_clock_jump,
                "continue: keep map and pose; reset: start anew from the current pose");
  visitor.Field("max_waiting_scans", max_waiting_scans,
                "scans kept while waiting for the IMU; the oldest is dropped beyond");
  visitor.Field("max_speed_mps", max_speed_mps,
                "speed that means divergence and causes a reset [m/s]");
  visitor.Field("max_imu_only_scans", max_imu_only_scans,
                "consecutive scans without a correction that cause a reset");
  visitor.Field("misfit_share", misfit_share,
                "a scan does not belong to the map when fewer of its points than this share of the "
                "usual number find a surface, 0 to 1, ...");
  visitor.Field("misfit_ratio", misfit_ratio,
                "... and these lie farther from it than so many times the usual distance");
  visitor.Field("misfit_scans", misfit_scans, "consecutive ones that cause a reset");
}

void RobustnessConfig::Validate(ConfigProblems& problems) const {
  problems.Require(imu_gap_s > 0.0, "robustness.imu_gap_s", "must be positive");
  problems.Require(clock_jump_s > imu_gap_s, "robustness.clock_jump_s",
                   "must be larger than imu_gap_s");
  problems.Require(on_clock_jump == "continue" || on_clock_jump == "reset",
                   "robustness.on_clock_jump", "must be 'continue' or 'reset'");
  problems.Require(max_waiting_scans >= 2, "robustness.max_waiting_scans", "must be at least 2");
  problems.Require(max_speed_mps > 0.0, "robustness.max_speed_mps", "must be positive");
  problems.Require(max_imu_only_scans >= 1, "robustness.max_imu_only_scans", "must be at least 1");
  problems.Require(misfit_share >= 0.0 && misfit_share < 1.0, "robustness.misfit_share",
                   "must be at least 0 and less than 1");
  problems.Require(misfit_ratio >= 1.0, "robustness.misfit_ratio", "must be at least 1");
  problems.Require(misfit_scans >= 1, "robustness.misfit_scans", "must be at least 1");
}

void LioConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("use_imu", use_imu, "false: constant-velocity model instead of an IMU");
  visitor.Field("threads", threads, "threads of one scan's work");
  visitor.Field("lidar_time_offset_s", lidar_time_offset_s,
                "added to LiDAR stamps to get IMU time [s]");
  visitor.Section("extrinsic", extrinsic, "T_imu_lidar: pose of the LiDAR in the IMU frame");
  visitor.Section("imu", imu, "noise and limits of the IMU");
  visitor.Section("initialization", initialization, "start of the odometry");
  visitor.Section("constant_velocity", constant_velocity, "motion model without an IMU");
  visitor.Section("preprocess", preprocess, "from points to cells");
  visitor.Section("map", map, "hash-voxel map");
  visitor.Section("update", update, "iterated Kalman update");
  visitor.Section("robustness", robustness, "disturbed input");
}

void LioConfig::Validate(ConfigProblems& problems) const {
  problems.Require(threads >= 1 && threads <= 256, "threads", "must lie between 1 and 256");
  problems.Require(std::abs(lidar_time_offset_s) < 10.0, "lidar_time_offset_s",
                   "must lie within 10 s");
  extrinsic.Validate(problems);
  imu.Validate(problems);
  initialization.Validate(problems);
  constant_velocity.Validate(problems);
  preprocess.Validate(problems);
  map.Validate(problems);
  update.Validate(problems);
  robustness.Validate(problems);
}

}  // namespace hv::lio
