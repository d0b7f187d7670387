#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>

#include <sensor_msgs/PointCloud2.h>

#include "hv_core/imu_sample.h"

namespace hv::lio {

/// Hands sensor messages from the ROS callbacks to the one thread that processes them, in order of
/// arrival. Drop policy: when more than `max_scans` clouds (or `max_imu` samples) wait, the oldest
/// waiting one of that kind is dropped and counted; a pushing thread never blocks. Thread-safe.
class InputQueue {
 public:
  /// One message: a cloud, or an IMU sample where `cloud` is null.
  struct Input {
    sensor_msgs::PointCloud2ConstPtr cloud;
    ImuSample imu;
    std::chrono::steady_clock::time_point arrival = std::chrono::steady_clock::now();
  };

  struct Counters {
    std::size_t scans_dropped = 0;
    std::size_t imu_dropped = 0;
  };

  InputQueue(std::size_t max_scans, std::size_t max_imu);

  void Push(const ImuSample& sample);
  void Push(const sensor_msgs::PointCloud2ConstPtr& cloud);

  /// Blocks until there is input. Nullopt once the queue is closed and empty.
  std::optional<Input> Pop();

  /// No further input is taken; what waits can still be popped.
  void Close();

  Counters counters() const;

 private:
  void PushInput(Input input);
  template <typename Predicate>
  void DropOldest(Predicate is_kind);

  const std::size_t max_scans_;
  const std::size_t max_imu_;
  mutable std::mutex mutex_;  // guards everything below
  std::condition_variable ready_;
  std::deque<Input> inputs_;
  std::size_t scans_waiting_ = 0;
  Counters counters_;
  bool closed_ = false;
};

}  // namespace hv::lio
