#pragma once

#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hv_core/point_cloud_decoder.h"
#include "hv_core/trajectory.h"
#include "hv_lio/pipeline.h"
#include "hv_lio/system_config.h"
#include "hv_replay/bag_reader.h"
#include "hv_replay/json.h"
#include "hv_replay/map_picture.h"

namespace hv::replay {

/// A CSV file that is flushed row by row, so that an interrupted run keeps its rows.
class CsvLog {
 public:
  /// Writes the header. Throws InputError when the file cannot be written.
  CsvLog(const std::string& path, const std::string& header);
  ~CsvLog();
  CsvLog(const CsvLog&) = delete;
  CsvLog& operator=(const CsvLog&) = delete;

  void Append(const std::string& row);

 private:
  std::FILE* file_;
};

/// What a run of odometry over bags has produced so far.
struct SlamRunSummary {
  std::map<std::string, std::size_t> scans_by_status;
  std::size_t clouds_unusable = 0;
  std::size_t degenerate_scans = 0;
  std::vector<double> total_ms;  ///< of tracked scans
  double path_length_m = 0.0;
  std::string time_layout;
  std::string error;  ///< why reading ended early, empty when it did not
  lio::PipelineCounters counters;
};

/// Resident memory of this process [MB].
double ResidentMemoryMb();

/// Odometry over bags with the core that the node uses: bags in, trajectory, timing and pictures
/// out.
class SlamRun {
 public:
  /// Creates `out_dir` and opens the bags. `pictures`: also collect and draw map.png and
  /// trajectory.png, whose memory grows with the area. Throws InputError.
  SlamRun(const lio::SystemConfig& config, const std::vector<std::string>& bags,
          const std::string& out_dir, bool pictures);

  /// Runs to the end of the bags and writes odometry.tum, timing.csv (a row a scan), covariance.csv
  /// (position and rotation covariance in odom axes, number of degenerate directions),
  /// summary.json, config.yaml and the pictures. A damaged bag ends the run early: what was finished is written,
  /// and the summary's `error` says why.
  SlamRunSummary Run();

 private:
  void AddCloud(const BagCloud& cloud);
  void AddImu(const BagImu& imu);
  void Drain(bool flush);
  void Take(const lio::ScanResult& result);
  void AddToPicture(const lio::ScanResult& result);
  void WriteResults(const Trajectory& odometry);

  lio::SystemConfig config_;
  std::string out_dir_;
  bool pictures_;
  BagReader reader_;
  PointCloudDecoder decoder_;
  lio::Pipeline pipeline_;
  CsvLog timing_;
  CsvLog covariance_;
  std::vector<StampedPose> poses_;  ///< in order of processing; a clock may have jumped back
  MapPicture picture_;
  SlamRunSummary summary_;
  std::string last_decode_error_;
};

/// The summary as JSON, for summary.json and `--json`.
JsonObject SummaryJson(const SlamRunSummary& summary);

}  // namespace hv::replay
