#include "odometry_engine.h"

#include <chrono>
#include <utility>

#include "hv_ros/conversions.h"

namespace hv::lio {

OdometryEngine::OdometryEngine(const SystemConfig& config)
    : decoder_(config.points), pipeline_(config.odometry) {}

std::vector<ScanResult> OdometryEngine::Process(const InputQueue::Input& input) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (input.cloud) {
    AddCloud(input);
  } else {
    pipeline_.AddImu(input.imu);
  }
  return Drain();
}

void OdometryEngine::AddCloud(const InputQueue::Input& input) {
  const auto start = std::chrono::steady_clock::now();
  DecodedScan decoded = decoder_.Decode(ViewOf(*input.cloud));
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  decode_counters_.points_not_finite += decoded.not_finite;
  decode_counters_.points_bad_time += decoded.bad_time;
  if (!decoded.error.empty()) {
    ++decode_counters_.clouds_unusable;
    last_decode_error_ = decoded.error;
  }
  pipeline_.AddScan(std::move(decoded.scan), spent.count(), input.arrival);
}

std::vector<ScanResult> OdometryEngine::Drain() {
  std::vector<ScanResult> results;
  while (auto result = pipeline_.ProcessNext()) results.push_back(std::move(*result));
  return results;
}

std::vector<ScanResult> OdometryEngine::Finish() {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<ScanResult> results;
  while (auto result = pipeline_.Flush()) results.push_back(std::move(*result));
  return results;
}

void OdometryEngine::Reset() {
  const std::lock_guard<std::mutex> lock(mutex_);
  pipeline_.Reset(true);
}

EngineCounters OdometryEngine::counters() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  EngineCounters counters{pipeline_.counters(), decode_counters_, "", last_decode_error_};
  if (decoder_.time_layout()) counters.time_layout = decoder_.time_layout()->ToString();
  return counters;
}

std::vector<std::string> OdometryEngine::TakeEvents() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return pipeline_.TakeEvents();
}

std::vector<VoxelView> OdometryEngine::ViewVoxels(std::size_t max) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return pipeline_.map().View(max);
}

}  // namespace hv::lio
