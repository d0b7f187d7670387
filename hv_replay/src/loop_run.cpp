#include "hv_replay/loop_run.h"

#include "hv_loop_btc/map_saver.h"
#include "hv_replay/console.h"
#include "hv_replay/csv_log.h"
#include "hv_replay/loop_table.h"

namespace hv::replay {

LoopRun::LoopRun(const SlamConfig& config, const std::string& out_dir)
    : config_(config),
      out_dir_(out_dir),
      keyframes_(config.system.output.keyframe_distance_m, config.system.output.keyframe_angle_deg),
      store_(out_dir + "/keyframes", config.loop.store,
             config.system.odometry.extrinsic.T_imu_lidar().translation()),
      closer_(config.loop, store_) {}

void LoopRun::Add(const lio::ScanResult& result) {
  const std::optional<Keyframe> keyframe = keyframes_.Add(result);
  if (!keyframe) return;
  ++summary_.keyframes;
  Note(closer_.Add(*keyframe));
}

void LoopRun::Note(const loop::LoopUpdate& update) {
  if (update.detection.extract_ms > 0.0) {
    summary_.detect_ms.push_back(update.detection.extract_ms + update.detection.query_ms);
    summary_.align_ms.push_back(update.detection.align_ms);
  }
  if (update.optimized) summary_.optimize_ms.push_back(1000.0 * update.graph.seconds);
}

LoopRunSummary LoopRun::Finish(const std::vector<StampedPose>& odometry) {
  Note(closer_.Finish());
  std::vector<StampedPose> corrected;
  corrected.reserve(odometry.size());
  for (const StampedPose& pose : odometry) {
    corrected.push_back({pose.stamp, closer_.Corrected(pose.stamp, pose.pose)});
  }
  WriteTum(out_dir_ + "/trajectory.tum", Trajectory(corrected));
  WriteLoops();
  if (summary_.keyframes > 0) WriteMap();
  summary_.candidates = closer_.candidates().size();
  for (const loop::LoopCandidate& loop : closer_.candidates()) summary_.loops += loop.accepted;
  return summary_;
}

void LoopRun::WriteLoops() const {
  CsvLog file(out_dir_ + "/loops.csv", LoopColumns());
  for (const loop::LoopCandidate& loop : closer_.candidates()) file.Append(LoopRow(loop));
}

void LoopRun::WriteMap() const {
  ProgressLine progress("map");
  loop::MapSaver(config_.map, ToYaml(config_))
      .Save(loop::SnapshotOf(closer_), store_, out_dir_ + "/map", loop::MapParts::kAll,
            [&progress](const char* stage, double share) { progress.Update(share, stage); });
}

}  // namespace hv::replay
