#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <vector>

#include "hv_ros/tracked_scan_message.h"

namespace hv::relocalize {

/// What is to be done next: the newest scan, and those that it has overtaken since the last one.
struct ScanBatch {
  /// In order of time, their points left out: their poses carry the place along. Predicted poses
  /// are not among them.
  std::vector<TrackedScanHeader> skipped;
  TrackedScanHeader header;
  std::vector<Point> points;  ///< IMU frame [m]; none for a pose that is only predicted
};

/// Hands scans from the ROS callback to the thread that localises: a queue of one, in which a new
/// scan takes the place of the one that waits. Only the pose of that one is kept, of at most a
/// thousand. Thread-safe.
class ScanQueue {
 public:
  void Push(DecodedTrackedScan scan);

  /// Blocks until there is a scan. Nothing once the queue is closed.
  std::optional<ScanBatch> Pop();

  /// Nothing is handed on any more.
  void Close();

  /// Scans with points that have been overtaken.
  std::size_t dropped() const;

 private:
  std::vector<TrackedScanHeader> TakeOvertaken();

  mutable std::mutex mutex_;  // guards everything below
  std::condition_variable ready_;
  std::optional<ScanBatch> waiting_;
  std::size_t dropped_ = 0;
  bool closed_ = false;
};

}  // namespace hv::relocalize
