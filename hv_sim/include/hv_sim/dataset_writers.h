#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hv_sim/faults.h"
#include "hv_sim/recording.h"

namespace hv::sim {

/// Puts a stream of sensor messages on disk in one data format. Not thread-safe.
class DatasetWriter {
 public:
  virtual ~DatasetWriter() = default;
  virtual void Write(const SensorMessage& message) = 0;
  /// Completes the files; nothing is written afterwards.
  virtual void Finish() = 0;
  /// Paths of what Finish() leaves behind.
  virtual std::vector<std::string> files() const = 0;
};

/// hilti: `recording.bag` (lz4) with /hesai/pandar (frame PandarXT-32) and /alphasense/imu (frame
/// imu_sensor_frame). robot: `recording.bag` with /points (lidar_link), /imu (imu_link) and
/// /tf_static from base_link. Both have clouds as the Hesai driver lays them out: x y z f32 at 0,
/// intensity f32 at 16, timestamp f64 (absolute seconds) at 24, ring u16 at 32, 48 bytes a point.
/// nclt: `velodyne_hits.bin` (a packet per twelve columns, utime of its first column),
/// `velodyne_sync/<utime of the start>.bin`, `ms25.csv`, `groundtruth_2012-01-10.csv` (z down,
/// body frame). The format is that of `recording`, which must outlive the writer. Throws
/// InputError when a file cannot be created.
std::unique_ptr<DatasetWriter> MakeDatasetWriter(const Recording& recording,
                                                 const std::string& directory);

struct DatasetOptions {
  std::string directory;  ///< made if need be
  std::vector<Fault> faults;
  int threads = 1;
  Recording::Progress progress;
};

struct DatasetSummary {
  std::vector<std::string> files;
  std::int64_t scans = 0;
  std::int64_t points = 0;
  std::int64_t imu_samples = 0;
  std::int64_t lost_messages = 0;  ///< to faults
  double path_length_m = 0.0;
};

/// Streams a recording through the faults into its format, and writes beside it `truth.tum` (IMU
/// frame in the world, 100 Hz and at each scan end), `calibration.yaml` (T_imu_lidar and IMU noise)
/// and `simulation.yaml` (the effective configuration). Throws InputError when the directory cannot
/// be written.
DatasetSummary WriteDataset(const Recording& recording, const DatasetOptions& options);

}  // namespace hv::sim
