#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>

#include <hv_msgs/TrackedScan.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

namespace hv::navigation {

/// What has come since the last time; what has not is null.
struct SensorInput {
  hv_msgs::TrackedScanConstPtr scan;
  sensor_msgs::ImageConstPtr image;
  sensor_msgs::CameraInfoConstPtr camera;  ///< of the image
};

/// Hands scans and depth images from the ROS callbacks to the thread that maps: of each sensor only
/// the newest waits, what it overtakes is dropped and counted. Thread-safe.
class SensorQueue {
 public:
  struct Counters {
    std::size_t scans_dropped = 0;
    std::size_t images_dropped = 0;
  };

  void Push(const hv_msgs::TrackedScanConstPtr& scan);
  void Push(const sensor_msgs::ImageConstPtr& image, const sensor_msgs::CameraInfoConstPtr& camera);

  /// Blocks until there is input. Nothing once the queue is closed.
  std::optional<SensorInput> Pop();

  /// Nothing is handed on any more.
  void Close();

  Counters counters() const;

 private:
  mutable std::mutex mutex_;  // guards everything below
  std::condition_variable ready_;
  SensorInput waiting_;
  Counters counters_;
  bool closed_ = false;
};

}  // namespace hv::navigation
