#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hv_core/imu_sample.h"
#include "hv_core/scan.h"
#include "hv_lio/lio_config.h"
#include "hv_lio/odometry_result.h"
#include "hv_lio/thread_arena.h"

namespace hv::lio {

/// The filter and its map: from one scan with the IMU samples that cover it to a pose. Input is
/// expected in order and free of gaps (see Pipeline). Not thread-safe.
class Odometry {
 public:
  explicit Odometry(const LioConfig& config);

  bool initialized() const { return initialized_; }
  /// Instant of the state: end of the last scan, or the last propagated sample.
  Time stamp() const { return stamp_; }

  /// Starts at `stamp` from an initial state, with an empty map. With a current pose kept by Reset,
  /// the pose goes on from there. From `initial.moving` each scan is matched to the one before,
  /// until the next Start (see StartInMotion).
  void Start(Time stamp, const InitialState& initial);

  /// Propagates to the end of the scan with `steps` (their durations add up from the current stamp
  /// to the scan end), deskews, updates, extends the map.
  ScanResult Process(const Scan& scan, const std::vector<ImuStep>& steps);

  /// Moves the clock without moving the state, after a jump of the sensor clock: up to a second of
  /// motion may have been missed, and the covariance says so.
  void MoveClock(Time stamp);

  /// Forgets the map and the motion. `keep_pose`: the next Start goes on from the current pose.
  void Reset(bool keep_pose);

  /// Current state with its covariances; `angular_velocity` without bias, IMU frame [rad/s].
  OdometryEstimate Estimate(const Eigen::Vector3d& angular_velocity) const;

  const NavState& state() const { return state_; }
  double accel_scale() const { return accel_scale_; }
  const VoxelMap& map() const { return map_; }

 private:
  std::vector<MotionKnot> PropagateKnots(const std::vector<ImuStep>& steps, double start_time);
  void WidenDegenerate(const UpdateSummary& update, double duration);

  LioConfig config_;
  Pose T_imu_lidar_;
  CellGrid grid_;
  ScanUpdate update_;
  VoxelMap map_;
  ThreadArena arena_;
  NavState state_;
  ErrorMatrix covariance_ = ErrorMatrix::Identity();
  std::optional<Pose> kept_pose_;
  Time stamp_;
  double accel_scale_ = 1.0;
  bool initialized_ = false;
  bool settling_ = false;  ///< scans are skewed by unknown motion: each is matched to the last
};

}  // namespace hv::lio
