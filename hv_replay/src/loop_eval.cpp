#include "hv_replay/loop_eval.h"

#include <cstdio>

#include "hv_core/error.h"
#include "hv_core/point_cloud_file.h"
#include "hv_core/trajectory.h"
#include "hv_replay/cloud_folder.h"
#include "hv_replay/console.h"
#include "hv_replay/csv_log.h"
#include "hv_replay/loop_table.h"

namespace hv::replay {
namespace {

/// Without odometry every place on this floor and every heading is possible.
loop::LoopConfig Blinded(loop::LoopConfig config) {
  constexpr double kEverywhere = 1e6;
  config.gate.base_translation_m = kEverywhere;
  config.gate.base_vertical_m = kEverywhere;
  config.gate.base_rotation_deg = 180.0;
  return config;
}

std::string Durations(const loop::LoopDetector::Timing& timing) {
  char text[100];
  std::snprintf(text, sizeof(text), ",%.3f,%.3f,%.3f", timing.extract_ms, timing.query_ms,
                timing.align_ms);
  return text;
}

/// Clouds are read while the closer runs; its store keeps them in a folder of its own meanwhile.
class Evaluation {
 public:
  Evaluation(const loop::LoopConfig& config, const std::string& csv)
      : store_(csv + ".clouds", config.store, Eigen::Vector3d::Zero()), closer_(config, store_) {}

  void Add(std::uint32_t id, const StampedPose& pose, std::vector<Point> points) {
    Keyframe keyframe;
    keyframe.id = id;
    keyframe.stamp = pose.stamp;
    keyframe.T_odom_imu = pose.pose;
    keyframe.covariance = 1e-6 * Matrix6d::Identity();
    keyframe.points = std::move(points);
    Note(closer_.Add(keyframe));
  }

  LoopEvalSummary Finish(const std::string& csv) {
    Note(closer_.Finish());
    CsvLog file(csv, LoopColumns() + ",extract_ms,query_ms,align_ms");
    for (std::size_t i = 0; i < closer_.candidates().size(); ++i) {
      const loop::LoopCandidate& candidate = closer_.candidates()[i];
      file.Append(LoopRow(candidate) + Durations(timings_[i]));
      summary_.accepted += candidate.accepted;
    }
    summary_.candidates = closer_.candidates().size();
    return summary_;
  }

 private:
  void Note(const loop::LoopUpdate& update) {
    timings_.resize(timings_.size() + update.candidates.size(), update.detection);
    if (update.detection.extract_ms == 0.0) return;
    ++summary_.submaps;
    summary_.detect_ms.push_back(update.detection.extract_ms + update.detection.query_ms);
  }

  KeyframeStore store_;
  loop::LoopCloser closer_;
  std::vector<loop::LoopDetector::Timing> timings_;  ///< one a candidate
  LoopEvalSummary summary_;
};

}  // namespace

LoopEvalSummary EvaluateLoops(const LoopEvalInput& input, const loop::LoopConfig& config,
                              const std::string& csv) {
  const Trajectory poses = ReadTum(input.poses);
  const std::vector<std::string> files = CloudFiles(input.clouds);
  if (files.size() != poses.size()) {
    throw InputError(input.clouds + ": " + std::to_string(files.size()) + " clouds for " +
                     std::to_string(poses.size()) + " poses");
  }
  Evaluation evaluation(input.blind ? Blinded(config) : config, csv);
  ProgressLine progress("loops");
  for (std::size_t i = 0; i < files.size(); ++i) {
    evaluation.Add(static_cast<std::uint32_t>(i), poses.poses()[i],
                   ReadPointCloud(files[i]).points);
    progress.Update(static_cast<double>(i + 1) / static_cast<double>(files.size()), "");
  }
  LoopEvalSummary summary = evaluation.Finish(csv);
  summary.clouds = files.size();
  return summary;
}

}  // namespace hv::replay
