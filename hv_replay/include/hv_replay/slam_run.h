#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hv_core/trajectory.h"
#include "hv_replay/csv_log.h"
#include "hv_replay/drift_injector.h"
#include "hv_replay/json.h"
#include "hv_replay/loop_run.h"
#include "hv_replay/map_picture.h"
#include "hv_replay/odometry_run.h"
#include "hv_replay/slam_config.h"

namespace hv::replay {

/// What a run of odometry over bags has produced so far.
struct SlamRunSummary {
  OdometryRunSummary odometry;
  std::map<std::string, std::size_t> scans_by_status;
  std::size_t degenerate_scans = 0;
  std::vector<double> total_ms;  ///< of tracked scans
  double path_length_m = 0.0;
  std::optional<LoopRunSummary> loops;  ///< nullopt without loop closing
};

/// What a run shall do beside odometry.
struct SlamRunOptions {
  bool loops = true;     ///< loop closing, trajectory.tum, loops.csv, map/
  bool pictures = true;  ///< map.png and trajectory.png, whose memory grows with the area
  std::optional<DriftRates> drift;
};

/// Odometry and loop closing over bags with the cores that the nodes use: bags in, trajectories,
/// map, timing and pictures out.
class SlamRun {
 public:
  /// Creates `out_dir` and opens the bags. Throws InputError.
  SlamRun(const SlamConfig& config, const std::vector<std::string>& bags,
          const std::string& out_dir, const SlamRunOptions& options);

  /// Runs to the end of the bags and writes odometry.tum, timing.csv (a row a scan), covariance.csv
  /// (position and rotation covariance in odom axes, number of degenerate directions),
  /// summary.json, config.yaml, the results of LoopRun and the pictures. A damaged bag ends the run
  /// early: what was finished is written, and the summary says why.
  SlamRunSummary Run();

 private:
  void Take(lio::ScanResult result);
  void AddToPicture(const lio::ScanResult& result);
  void WriteResults(const Trajectory& odometry);

  SlamConfig config_;
  std::string out_dir_;
  SlamRunOptions options_;
  OdometryRun odometry_;
  CsvLog timing_;
  CsvLog covariance_;
  std::vector<StampedPose> poses_;  ///< in order of processing; a clock may have jumped back
  std::optional<LoopRun> loops_;
  std::optional<DriftInjector> drift_;
  MapPicture picture_;
  SlamRunSummary summary_;
};

/// The summary as JSON, for summary.json and `--json`.
JsonObject SummaryJson(const SlamRunSummary& summary);

}  // namespace hv::replay
