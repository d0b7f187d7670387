#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>

#include <hv_msgs/Keyframe.h>

namespace hv::loop {

/// Hands keyframes from the ROS callback to the thread that processes them, in order of arrival.
/// None is ever dropped: the oldest `max_in_memory` wait in memory, those behind them as files in
/// `folder`, so that memory stays bounded however far processing falls behind. A keyframe that the
/// disk does not take stays in memory. Thread-safe.
class KeyframeQueue {
 public:
  struct Counters {
    std::size_t waiting = 0;
    std::size_t on_disk = 0;      ///< of these
    std::size_t disk_errors = 0;  ///< keyframes that could not be written, and stayed in memory
    std::size_t lost = 0;         ///< keyframes whose file could not be read back
  };

  /// `folder` exists; what an earlier run left waiting there is removed.
  KeyframeQueue(std::string folder, std::size_t max_in_memory);
  /// Removes the files of what still waits.
  ~KeyframeQueue();
  KeyframeQueue(const KeyframeQueue&) = delete;
  KeyframeQueue& operator=(const KeyframeQueue&) = delete;

  void Push(const hv_msgs::KeyframeConstPtr& keyframe);

  /// Blocks until there is a keyframe. Null once the queue is closed and empty.
  hv_msgs::KeyframeConstPtr Pop();

  /// No further keyframe is taken; what waits can still be popped.
  void Close();

  Counters counters() const;

 private:
  /// In memory, or in a file when `keyframe` is null.
  struct Entry {
    hv_msgs::KeyframeConstPtr keyframe;
    std::uint64_t number = 0;  ///< names the file
  };

  std::string PathOf(std::uint64_t number) const;
  bool WriteFile(const Entry& entry) const;
  hv_msgs::KeyframeConstPtr ReadFile(std::uint64_t number) const;

  const std::string folder_;
  const std::size_t max_in_memory_;
  mutable std::mutex mutex_;  // guards everything below
  std::condition_variable ready_;
  std::deque<Entry> entries_;
  std::uint64_t next_number_ = 0;
  Counters counters_;
  bool closed_ = false;
};

}  // namespace hv::loop
