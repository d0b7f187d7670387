#include "scan_queue.h"

#include <utility>

namespace hv::relocalize {
namespace {

constexpr std::size_t kMostSkipped = 1000;

}  // namespace

void ScanQueue::Push(DecodedTrackedScan scan) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (closed_) return;
    ScanBatch batch{TakeOvertaken(), std::move(scan.header), std::move(scan.points)};
    waiting_ = std::move(batch);
  }
  ready_.notify_one();
}

std::vector<TrackedScanHeader> ScanQueue::TakeOvertaken() {
  if (!waiting_) return {};
  std::vector<TrackedScanHeader> skipped = std::move(waiting_->skipped);
  if (waiting_->points.empty()) return skipped;
  ++dropped_;
  if (skipped.size() >= kMostSkipped) skipped.erase(skipped.begin());
  skipped.push_back(std::move(waiting_->header));
  return skipped;
}

std::optional<ScanBatch> ScanQueue::Pop() {
  std::unique_lock<std::mutex> lock(mutex_);
  ready_.wait(lock, [this] { return closed_ || waiting_.has_value(); });
  if (closed_) return std::nullopt;
  return std::exchange(waiting_, std::nullopt);
}

void ScanQueue::Close() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
  }
  ready_.notify_all();
}

std::size_t ScanQueue::dropped() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return dropped_;
}

}  // namespace hv::relocalize
