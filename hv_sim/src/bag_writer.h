#pragma once

#include <string>
#include <vector>

#include <rosbag/bag.h>

#include "hv_sim/dataset_writers.h"

namespace hv::sim {

/// Topics and frames of a bag.
struct BagLayout {
  std::string points_topic;
  std::string imu_topic;
  std::string lidar_frame;
  std::string imu_frame;
  std::string base_frame;  ///< parent of both on /tf_static; empty: no /tf_static
};

/// A ROS 1 bag, compressed with lz4, that appears under its name only when finished.
class BagWriter : public DatasetWriter {
 public:
  BagWriter(const Recording& recording, const std::string& path);

  void Write(const SensorMessage& message) override;
  void Finish() override;
  std::vector<std::string> files() const override { return {path_}; }

 private:
  void WriteStaticTransforms(const Recording& recording);
  void WriteScan(const SensorMessage& message, const Scan& scan);
  void WriteImu(const SensorMessage& message, const ImuSample& sample);

  std::string path_;
  BagLayout layout_;
  ImuConfig imu_config_;
  rosbag::Bag bag_;
  std::uint32_t scan_sequence_ = 0;
  std::uint32_t imu_sequence_ = 0;
};

}  // namespace hv::sim
