#include "hv_replay/localize_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "hv_core/angles.h"
#include "hv_replay/map_picture.h"
#include "hv_replay/result_files.h"
#include "hv_replay/trajectory_error.h"
#include "tracked_scan.h"

namespace hv::replay {
namespace {

std::string RowOf(const relocalize::LocalizerUpdate& update, Time stamp, double elapsed_ms) {
  char text[256];
  std::snprintf(text, sizeof(text), ",%d,%d,%.4f,%.4f,%.4f,%.5f,%.5f,%.3f,%.3f,",
                update.registered ? 1 : 0, update.searched ? 1 : 0, update.score.fit,
                update.score.overlap, update.score.seen_through,
                std::sqrt(update.covariance.topLeftCorner<3, 3>().trace()),
                kDegreesPerRadian * std::sqrt(update.covariance.bottomRightCorner<3, 3>().trace()),
                update.innovation, elapsed_ms);
  return ToString(stamp) + "," + ToString(update.state) + text + update.reason;
}

JsonObject DurationsJson(const std::vector<double>& milliseconds) {
  const Statistics times = Summarize(milliseconds);
  JsonObject json;
  json.Add("mean", times.mean).Add("median", times.median).Add("max", times.max);
  return json;
}

}  // namespace

LocalizeRun::LocalizeRun(const SlamConfig& config, const LocalizeRunOptions& options)
    : config_(config),
      options_(options),
      map_(relocalize::PriorMap::Load(options.map, config.localization.relocalize)),
      localizer_(config.localization, map_),
      odometry_(config.system, options.bags, "hv_localize"),
      log_(CreateDirectory(options.out) + "/localization.csv",
           "stamp,state,registered,searched,fit,overlap,seen_through,sigma_m,sigma_deg,innovation,"
           "ms,reason") {
  if (options.guess) localizer_.SetGuess({*options.guess});
}

LocalizeRunSummary LocalizeRun::Run() {
  WriteText(options_.out + "/config.yaml", ToYaml(config_));
  odometry_.clock = [this](Time now) {
    const relocalize::LocalizerUpdate update = localizer_.Wait(now);
    if (update.state != state_) Note(update, now, 0.0);
  };
  summary_.odometry =
      odometry_.Run([this](const lio::ScanResult& result) { Take(result); }, "localisation");
  const Trajectory trajectory(poses_);
  WriteTum(options_.out + "/trajectory.tum", trajectory);
  WriteText(options_.out + "/summary.json", SummaryJson(summary_).ToString() + "\n");
  if (options_.pictures) Draw(trajectory);
  return summary_;
}

void LocalizeRun::Draw(const Trajectory& trajectory) const {
  constexpr double kCell_m = 0.1;
  MapPicture picture(kCell_m);
  for (const Eigen::Vector3f& point : map_.points()) picture.Add(point.cast<double>());
  picture.Save(trajectory, "localised in the map", options_.out + "/map.png");
}

void LocalizeRun::Take(const lio::ScanResult& result) {
  if (result.status != lio::ScanStatus::kTracking || !result.deskewed) return;
  ++summary_.scans;
  const Time stamp = result.estimate.stamp;
  if (!lost_since_ && state_ == relocalize::LocalizerState::kLost) lost_since_ = stamp;
  const auto start = std::chrono::steady_clock::now();
  const relocalize::LocalizerUpdate update = localizer_.Add(
      TrackedScanOf(result, config_.system.odometry.extrinsic.T_imu_lidar().translation()));
  const std::chrono::duration<double, std::milli> elapsed =
      std::chrono::steady_clock::now() - start;
  Note(update, stamp, elapsed.count());
  if (update.state == relocalize::LocalizerState::kLost) return;
  ++summary_.localized;
  poses_.push_back({stamp, update.T_map_imu});
}

void LocalizeRun::Note(const relocalize::LocalizerUpdate& update, Time stamp, double elapsed_ms) {
  log_.Append(RowOf(update, stamp, elapsed_ms));
  if (update.registered) {
    (update.searched ? summary_.search_ms : summary_.track_ms).push_back(elapsed_ms);
  }
  const bool was_lost = state_ == relocalize::LocalizerState::kLost;
  const bool is_lost = update.state == relocalize::LocalizerState::kLost;
  state_ = update.state;
  if (!was_lost && is_lost) ++summary_.losses;
  if (is_lost || !lost_since_) return;
  const double lost_s = stamp - *lost_since_;
  lost_since_.reset();
  if (summary_.first_pose_s < 0.0) {
    summary_.first_pose_s = lost_s;
  } else {
    summary_.longest_search_s = std::max(summary_.longest_search_s, lost_s);
  }
}

JsonObject SummaryJson(const LocalizeRunSummary& summary) {
  JsonObject json;
  json.AddCount("scans", summary.scans)
      .AddCount("localized", summary.localized)
      .AddCount("losses", summary.losses)
      .Add("first_pose_s", summary.first_pose_s)
      .Add("longest_search_s", summary.longest_search_s)
      .Add("track_ms", DurationsJson(summary.track_ms))
      .Add("search_ms", DurationsJson(summary.search_ms))
      .Add("error", summary.odometry.error);
  return json;
}

}  // namespace hv::replay
