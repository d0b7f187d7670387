#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <sensor_msgs/PointCloud2.h>

#include "hv_core/point_cloud_decoder.h"
#include "hv_lio/pipeline.h"
#include "hv_lio/system_config.h"
#include "input_queue.h"

namespace hv::lio {

/// Counts of what was wrong with clouds before the pipeline saw them.
struct DecodeCounters {
  std::size_t clouds_unusable = 0;  ///< no xyz, contradicting sizes
  std::size_t points_not_finite = 0;
  std::size_t points_bad_time = 0;
};

struct EngineCounters {
  PipelineCounters pipeline;
  DecodeCounters decode;
  std::string time_layout;  ///< what was recognised about point times, empty before
  std::string last_decode_error;
};

/// Decoder and pipeline behind one lock. Results are returned, never published under the lock.
/// Thread-safe.
class OdometryEngine {
 public:
  /// Throws InputError when the configuration is invalid.
  explicit OdometryEngine(const SystemConfig& config);

  /// Takes one message in and returns every scan that is complete now.
  std::vector<ScanResult> Process(const InputQueue::Input& input);

  /// At the end: the scans that were still waiting for later IMU samples.
  std::vector<ScanResult> Finish();

  /// Forgets map and buffers; odometry goes on from the current pose.
  void Reset();

  EngineCounters counters() const;
  std::vector<std::string> TakeEvents();
  std::vector<VoxelView> ViewVoxels(std::size_t max) const;

 private:
  void AddCloud(const InputQueue::Input& input);
  std::vector<ScanResult> Drain();

  mutable std::mutex mutex_;  // guards everything below
  PointCloudDecoder decoder_;
  Pipeline pipeline_;
  DecodeCounters decode_counters_;
  std::string last_decode_error_;
};

}  // namespace hv::lio
