#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hv_core/point_cloud_decoder.h"
#include "hv_lio/pipeline.h"
#include "hv_lio/system_config.h"
#include "hv_replay/bag_reader.h"

namespace hv::replay {

/// What was read.
struct OdometryRunSummary {
  std::size_t clouds_unusable = 0;
  std::string time_layout;
  std::string error;  ///< why reading ended early, empty when it did not
  lio::PipelineCounters counters;
};

/// Odometry over bags with the core that the node uses. What is wrong with a bag or its scans is
/// told once a cause, on standard error.
class OdometryRun {
 public:
  using Sink = std::function<void(lio::ScanResult)>;

  /// Opens the bags. `program` begins each line on standard error. Throws InputError.
  OdometryRun(const lio::SystemConfig& config, const std::vector<std::string>& bags,
              std::string program);

  /// Called with the stamp of each IMU sample.
  std::function<void(Time)> clock;

  /// Runs to the end of the bags; every result goes to `sink`, in order. A damaged bag ends the run
  /// early: the summary's `error` says why.
  OdometryRunSummary Run(const Sink& sink, const std::string& label);

 private:
  void AddCloud(const BagCloud& cloud);
  void AddImu(const BagImu& imu);
  void Drain(bool flush);
  void Warn(const std::string& line) const;

  std::string program_;
  BagReader reader_;
  PointCloudDecoder decoder_;
  lio::Pipeline pipeline_;
  Sink sink_;
  OdometryRunSummary summary_;
  std::string last_decode_error_;
};

}  // namespace hv::replay
