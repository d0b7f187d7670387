#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "hv_core/trajectory.h"
#include "hv_relocalize_ndt/localizer.h"
#include "hv_replay/csv_log.h"
#include "hv_replay/json.h"
#include "hv_replay/odometry_run.h"
#include "hv_replay/slam_config.h"

namespace hv::replay {

/// What a run of localisation over bags has produced.
struct LocalizeRunSummary {
  OdometryRunSummary odometry;
  std::size_t scans = 0;       ///< with odometry
  std::size_t localized = 0;   ///< of these, with a place in the map
  std::size_t losses = 0;      ///< times that the place was lost
  double first_pose_s = -1.0;  ///< from the first scan with odometry to the first place; -1: none
  double longest_search_s = 0.0;  ///< from scans after a loss to the next place, by the recording
  std::vector<double> track_ms;   ///< of comparisons while tracking
  std::vector<double> search_ms;  ///< of searches
};

/// What is localised, and where.
struct LocalizeRunOptions {
  std::string map;                ///< folder, PCD or PLY
  std::vector<std::string> bags;  ///< read as one
  std::string out;                ///< folder for the results
  std::optional<Pose> guess;      ///< of the IMU in the map at the first scan
  bool pictures = true;           ///< map.png
};

/// Localisation in a saved map over bags with the cores that the nodes use: odometry and Localizer.
class LocalizeRun {
 public:
  /// Creates the folder for the results, reads the map and opens the bags. Throws InputError.
  LocalizeRun(const SlamConfig& config, const LocalizeRunOptions& options);

  /// Runs to the end of the bags and writes trajectory.tum (poses of the IMU in the map at scan
  /// ends, while localised), localization.csv (a row a scan), summary.json, config.yaml and
  /// map.png, the map with the trajectory.
  LocalizeRunSummary Run();

 private:
  void Take(const lio::ScanResult& result);
  void Note(const relocalize::LocalizerUpdate& update, Time stamp, double elapsed_ms);
  void Draw(const Trajectory& trajectory) const;

  SlamConfig config_;
  LocalizeRunOptions options_;
  relocalize::PriorMap map_;
  relocalize::Localizer localizer_;
  OdometryRun odometry_;
  CsvLog log_;
  std::vector<StampedPose> poses_;
  std::optional<Time> lost_since_;  ///< first scan without a place
  relocalize::LocalizerState state_ = relocalize::LocalizerState::kLost;
  LocalizeRunSummary summary_;
};

/// The summary as JSON, for summary.json and `--json`.
JsonObject SummaryJson(const LocalizeRunSummary& summary);

}  // namespace hv::replay
