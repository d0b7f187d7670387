#pragma once

#include <cstddef>
#include <deque>
#include <mutex>
#include <string>

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include "hv_core/recent_durations.h"
#include "hv_core/time.h"
#include "hv_lio/odometry_result.h"
#include "input_queue.h"
#include "odometry_engine.h"

namespace hv::lio {

/// Rate of a stream by its stamps, so that it does not depend on the speed of a replay.
class RateMeter {
 public:
  void Add(Time stamp);
  double hz() const;

 private:
  std::deque<Time> stamps_;  // of the last seconds
};

/// Collects what the node knows about itself and fills the diagnostics. Thread-safe.
class Health {
 public:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  void OnImu(Time stamp);
  void OnCloud(Time stamp);
  void OnScan(const ScanResult& result);
  /// Its pose has just been sent.
  void OnPublished(const ScanResult& result);
  void OnCounters(const EngineCounters& engine, const InputQueue::Counters& queue);

  /// One line that overrides the state while not empty (silent topic, waiting for tf, paused).
  void SetProblem(const std::string& problem);

  /// Level, status, reason, residuals, degenerate directions, gravity, biases.
  void DescribeOdometry(Status& status);
  /// Rates, point-time layout, counters of every fault.
  void DescribeInput(Status& status);
  /// Time a scan, from its arrival to its pose, voxels, resident memory.
  void DescribeResources(Status& status);

 private:
  static constexpr std::size_t kTimedScans = 100;    // 10 s at 10 Hz
  static constexpr std::size_t kTimedPoses = 10000;  // 1000 s

  void Summarize(Status& status) const;
  std::size_t Faults() const;

  mutable std::mutex mutex_;  // guards everything below
  RateMeter imu_rate_;
  RateMeter cloud_rate_;
  std::string problem_;
  bool any_scan_ = false;
  ScanResult last_;  // without its points
  RecentDurations scans_{kTimedScans};
  RecentDurations latencies_{kTimedPoses};
  EngineCounters engine_;
  InputQueue::Counters queue_;
  std::size_t reported_faults_ = 0;
};

}  // namespace hv::lio
