#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "hv_core/imu_sample.h"
#include "hv_core/scan.h"
#include "hv_lio/constant_velocity.h"
#include "hv_lio/imu_buffer.h"
#include "hv_lio/initializer.h"
#include "hv_lio/lio_config.h"
#include "hv_lio/match_monitor.h"
#include "hv_lio/moving_start.h"
#include "hv_lio/odometry.h"
#include "hv_lio/odometry_result.h"

namespace hv::lio {

/// Counts of everything unusual since construction, for diagnostics and summaries.
struct PipelineCounters {
  std::size_t scans = 0;  ///< handed in
  std::size_t scans_tracked = 0;
  std::size_t scans_imu_only = 0;
  std::size_t scans_dropped = 0;  ///< too old, without IMU, or overrun of the queue
  std::size_t imu_samples = 0;
  std::size_t imu_out_of_order = 0;
  std::size_t imu_invalid = 0;  ///< not finite
  std::size_t imu_saturated = 0;
  std::size_t imu_gaps = 0;
  std::size_t clock_jumps = 0;
  std::size_t resets = 0;

  /// Times that the map was forgotten or the clock jumped: no odometry across.
  std::size_t segments() const { return resets + clock_jumps; }
};

/// From raw scans and IMU samples, in order of arrival, to odometry: pairs each scan with the IMU
/// samples that cover it, deals with gaps, disorder and clock jumps, and runs the filter. The
/// offline tool and the node both drive this class, so the same data give the same answer.
/// Not thread-safe: one thread feeds and drains it.
class Pipeline {
 public:
  /// Throws InputError when the configuration is invalid.
  explicit Pipeline(const LioConfig& config);

  /// Hands in one IMU sample (acceleration in m/s^2 or g; recognised at the start). Never throws.
  void AddImu(const ImuSample& sample);

  /// Hands in one scan in the LiDAR frame; `decode_ms` is added to its preprocessing time,
  /// `arrival` comes back with its result.
  void AddScan(Scan scan, double decode_ms = 0.0,
               std::chrono::steady_clock::time_point arrival = std::chrono::steady_clock::now());

  /// Processes the oldest waiting scan whose end the IMU has reached; nullopt when there is none.
  /// Call until it returns nullopt after every AddImu/AddScan.
  std::optional<ScanResult> ProcessNext();

  /// At the end of the data: like ProcessNext, but no longer waits for later IMU samples.
  std::optional<ScanResult> Flush();

  /// Forgets map, state and buffers. With `keep_pose` the odometry goes on from the current pose so
  /// that odom stays continuous.
  void Reset(bool keep_pose);

  const PipelineCounters& counters() const { return counters_; }

  /// One line each for what happened since the last call (gap, jump, unit recognised, reset ...).
  std::vector<std::string> TakeEvents();

  /// For visualisation; valid until the next non-const call.
  const VoxelMap& map() const;

 private:
  struct WaitingScan {
    Scan scan;
    double decode_ms = 0.0;
    std::chrono::steady_clock::time_point arrival;
  };

  bool CoveredByImu(const Scan& scan) const;
  ScanResult ProcessOldest();
  ScanResult Track(const Scan& scan);
  void TryStart(const Scan& scan, ScanResult& result);
  void RememberForStart(const Scan& scan);
  std::vector<WindowScan> StartWindow(double accel_scale) const;
  void ForgetStart();
  std::vector<ImuStep> StepsTo(const Scan& scan);
  void FollowClock(Time stamp, const char* source);
  void Supervise(ScanResult& result);
  void Note(std::string event);

  LioConfig config_;
  Odometry odometry_;
  Initializer initializer_;
  std::deque<Scan> start_scans_;  ///< newest scans before the start, for one in motion
  ConstantVelocityModel constant_velocity_;
  ImuBuffer imu_;
  std::deque<WaitingScan> scans_;
  int imu_only_streak_ = 0;
  MatchMonitor match_;
  PipelineCounters counters_;
  std::vector<std::string> events_;
};

}  // namespace hv::lio
