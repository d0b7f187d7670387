#include "hv_replay/slam_run.h"

#include <algorithm>
#include <utility>

#include "hv_core/memory.h"
#include "hv_replay/plot.h"
#include "hv_replay/result_files.h"
#include "quantile.h"

namespace hv::replay {
namespace {

/// Every n-th point of a scan goes into the picture of the map.
constexpr std::size_t kPictureStride = 7;

double Mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

std::string TimingRow(const lio::ScanResult& result) {
  const lio::ScanTiming& timing = result.timing;
  char row[200];
  std::snprintf(row, sizeof(row), "%s,%.4f,%.4f,%.4f,%.4f,%zu,%.2f",
                ToString(result.estimate.stamp).c_str(), timing.preprocess_ms, timing.update_ms,
                timing.map_ms, timing.total_ms(), result.voxels, ResidentMegabytes());
  return row;
}

std::string CovarianceRow(const lio::ScanResult& result) {
  std::string row = ToString(result.estimate.stamp);
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < (i < 3 ? 3 : 6); ++j) {
      char cell[40];
      std::snprintf(cell, sizeof(cell), ",%.6e", result.estimate.pose_covariance(i, j));
      row += cell;
    }
  }
  return row + "," + std::to_string(result.update.degenerate_translation.size()) + "," +
         std::to_string(result.update.degenerate_rotation.size());
}

JsonObject SlamTimesJson(const std::vector<double>& milliseconds) {
  JsonObject times;
  times.Add("mean", Mean(milliseconds))
      .Add("median", Quantile(milliseconds, 0.5))
      .Add("p99", Quantile(milliseconds, 0.99))
      .Add("max", Quantile(milliseconds, 1.0));
  return times;
}

JsonObject LoopsJson(const LoopRunSummary& summary) {
  JsonObject json;
  json.AddCount("keyframes", summary.keyframes)
      .AddCount("candidates", summary.candidates)
      .AddCount("accepted", summary.loops)
      .Add("detect_ms", SlamTimesJson(summary.detect_ms))
      .Add("align_ms", SlamTimesJson(summary.align_ms))
      .Add("optimize_ms", SlamTimesJson(summary.optimize_ms));
  return json;
}

}  // namespace

SlamRun::SlamRun(const SlamConfig& config, const std::vector<std::string>& bags,
                 const std::string& out_dir, const SlamRunOptions& options)
    : config_(config),
      out_dir_(CreateDirectory(out_dir)),
      options_(options),
      odometry_(config.system, bags, "hv_slam"),
      timing_(out_dir + "/timing.csv",
              "stamp,preprocess_ms,update_ms,map_ms,total_ms,voxels,rss_mb"),
      covariance_(out_dir + "/covariance.csv",
                  "stamp,xx,xy,xz,yy,yz,zz,rxrx,rxry,rxrz,ryry,ryrz,rzrz,"
                  "degenerate_translation,degenerate_rotation") {
  if (options.loops) loops_.emplace(config, out_dir);
  if (options.drift) drift_.emplace(*options.drift);
}

SlamRunSummary SlamRun::Run() {
  WriteText(out_dir_ + "/config.yaml", ToYaml(config_));
  summary_.odometry =
      odometry_.Run([this](lio::ScanResult result) { Take(std::move(result)); }, "odometry");
  const Trajectory odometry(poses_);
  summary_.path_length_m = odometry.PathLength();
  WriteResults(odometry);
  return summary_;
}

void SlamRun::Take(lio::ScanResult result) {
  ++summary_.scans_by_status[lio::ToString(result.status)];
  const bool tracking = result.status == lio::ScanStatus::kTracking;
  if (!tracking && result.status != lio::ScanStatus::kImuOnly) return;
  if (drift_) result.estimate.T_odom_imu = drift_->Apply(result.estimate.T_odom_imu);
  timing_.Append(TimingRow(result));
  covariance_.Append(CovarianceRow(result));
  poses_.push_back({result.estimate.stamp, result.estimate.T_odom_imu});
  if (!tracking) return;
  if (loops_) loops_->Add(result);
  summary_.total_ms.push_back(result.timing.total_ms());
  summary_.degenerate_scans += result.update.degenerate() ? 1U : 0U;
  if (options_.pictures) AddToPicture(result);
}

void SlamRun::AddToPicture(const lio::ScanResult& result) {
  const std::vector<Point>& points = *result.deskewed;
  for (std::size_t i = 0; i < points.size(); i += kPictureStride) {
    picture_.Add(result.estimate.T_odom_imu *
                 Eigen::Vector3d(points[i].x, points[i].y, points[i].z));
  }
}

void SlamRun::WriteResults(const Trajectory& odometry) {
  WriteTum(out_dir_ + "/odometry.tum", odometry);
  if (loops_) summary_.loops = loops_->Finish(poses_);
  WriteText(out_dir_ + "/summary.json", SummaryJson(summary_).ToString() + "\n");
  if (!options_.pictures || odometry.size() < 2 || picture_.cells() == 0) return;
  PlotTrajectories({{"odometry", odometry, false}}, "HV-LIO odometry",
                   out_dir_ + "/trajectory.png");
  picture_.Save(odometry, "HV-LIO map", out_dir_ + "/map.png");
}

JsonObject SummaryJson(const SlamRunSummary& summary) {
  JsonObject statuses;
  for (const auto& [status, count] : summary.scans_by_status) statuses.AddCount(status, count);
  const lio::PipelineCounters& counters = summary.odometry.counters;
  JsonObject input;
  input.AddCount("scans", counters.scans)
      .AddCount("clouds_unusable", summary.odometry.clouds_unusable)
      .AddCount("imu_samples", counters.imu_samples)
      .AddCount("imu_gaps", counters.imu_gaps)
      .AddCount("imu_out_of_order", counters.imu_out_of_order)
      .AddCount("imu_invalid", counters.imu_invalid)
      .AddCount("imu_saturated", counters.imu_saturated)
      .AddCount("clock_jumps", counters.clock_jumps)
      .AddCount("resets", counters.resets);
  JsonObject json;
  if (summary.loops) json.Add("loops", LoopsJson(*summary.loops));
  json.Add("scans", statuses)
      .Add("path_length_m", summary.path_length_m)
      .AddCount("degenerate_scans", summary.degenerate_scans)
      .Add("scan_ms", SlamTimesJson(summary.total_ms))
      .Add("input", input)
      .Add("point_time", summary.odometry.time_layout)
      .Add("resident_mb", ResidentMegabytes())
      .Add("error", summary.odometry.error);
  return json;
}

}  // namespace hv::replay
