#include "input_queue.h"

#include <algorithm>
#include <utility>

namespace hv::lio {

InputQueue::InputQueue(std::size_t max_scans, std::size_t max_imu)
    : max_scans_(max_scans), max_imu_(max_imu) {}

void InputQueue::Push(const ImuSample& sample) { PushInput({nullptr, sample}); }

void InputQueue::Push(const sensor_msgs::PointCloud2ConstPtr& cloud) { PushInput({cloud, {}}); }

void InputQueue::PushInput(Input input) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (closed_) return;
    if (input.cloud) ++scans_waiting_;
    inputs_.push_back(std::move(input));
    if (scans_waiting_ > max_scans_) {
      DropOldest([](const Input& waiting) { return waiting.cloud != nullptr; });
      --scans_waiting_;
      ++counters_.scans_dropped;
    } else if (inputs_.size() - scans_waiting_ > max_imu_) {
      DropOldest([](const Input& waiting) { return waiting.cloud == nullptr; });
      ++counters_.imu_dropped;
    }
  }
  ready_.notify_one();
}

template <typename Predicate>
void InputQueue::DropOldest(Predicate is_kind) {
  inputs_.erase(std::find_if(inputs_.begin(), inputs_.end(), is_kind));
}

std::optional<InputQueue::Input> InputQueue::Pop() {
  std::unique_lock<std::mutex> lock(mutex_);
  ready_.wait(lock, [this] { return closed_ || !inputs_.empty(); });
  if (inputs_.empty()) return std::nullopt;
  Input input = std::move(inputs_.front());
  inputs_.pop_front();
  if (input.cloud) --scans_waiting_;
  return input;
}

void InputQueue::Close() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
  }
  ready_.notify_all();
}

InputQueue::Counters InputQueue::counters() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return counters_;
}

}  // namespace hv::lio
