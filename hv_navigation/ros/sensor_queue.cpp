#include "sensor_queue.h"

#include <utility>

namespace hv::navigation {

void SensorQueue::Push(const hv_msgs::TrackedScanConstPtr& scan) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (waiting_.scan) ++counters_.scans_dropped;
    waiting_.scan = scan;
  }
  ready_.notify_one();
}

void SensorQueue::Push(const sensor_msgs::ImageConstPtr& image,
                       const sensor_msgs::CameraInfoConstPtr& camera) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (waiting_.image) ++counters_.images_dropped;
    waiting_.image = image;
    waiting_.camera = camera;
  }
  ready_.notify_one();
}

std::optional<SensorInput> SensorQueue::Pop() {
  std::unique_lock<std::mutex> lock(mutex_);
  ready_.wait(lock, [this] { return closed_ || waiting_.scan || waiting_.image; });
  if (closed_) return std::nullopt;
  return std::exchange(waiting_, SensorInput());
}

void SensorQueue::Close() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
  }
  ready_.notify_all();
}

SensorQueue::Counters SensorQueue::counters() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return counters_;
}

}  // namespace hv::navigation
