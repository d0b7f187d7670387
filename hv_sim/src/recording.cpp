#include "hv_sim/recording.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <future>
#include <utility>

#include <tbb/global_control.h>

namespace hv::sim {
namespace {

constexpr double kTruthRateHz = 100.0;

MotionConfig Seeded(MotionConfig motion, int seed) {
  motion.seed = seed;
  return motion;
}

LidarOptions MakeLidarOptions(const RecordingConfig& config) {
  LidarOptions options;
  options.noise = config.lidar_noise;
  options.people = config.people;
  options.dropout = config.lidar_dropout;
  options.azimuth_keep = config.point_share;
  return options;
}

}  // namespace

void RecordingConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("world", world, "name of a world or path of a map_server YAML");
  visitor.Field("format", format, "hilti, nclt or robot");
  visitor.Field("seed", seed, "of clutter, motion and noise");
  visitor.Field("world_seed", world_seed, "of clutter; below 0: as seed");
  visitor.Section("motion", motion, "trajectory of the carrier");
  visitor.Field("lidar_noise", lidar_noise, "range noise and mixed pixels");
  visitor.Field("people", people, "people walk around");
  visitor.Field("lidar_dropout", lidar_dropout, "probability that a return is lost");
  visitor.Field("point_share", point_share, "share of LiDAR columns fired, for smaller files");
  visitor.Section("suite", suite, "sensors and where they sit");
}

void RecordingConfig::Validate(ConfigProblems& problems) const {
  motion.Validate(problems);
  suite.Validate(problems);
  problems.Require(lidar_dropout >= 0.0 && lidar_dropout <= 1.0, "lidar_dropout",
                   "must be in [0, 1]");
  problems.Require(point_share > 0.0 && point_share <= 1.0, "point_share", "must be in (0, 1]");
}

Recording::Recording(const World& world, const RecordingConfig& config)
    : config_(config),
      rig_(MakeRig(config.suite)),
      lidar_(world, MakeLidarModel(config.suite), MakeLidarOptions(config),
             static_cast<std::uint32_t>(config.seed)),
      motion_(MakeMotion(world, Seeded(config.motion, config.seed))) {}

double Recording::ScanStart(int index) const {
  return config_.suite.first_scan_s + index * lidar_.model().period();
}

int Recording::scan_count() const {
  const double time = config_.motion.duration_s - config_.suite.first_scan_s;
  return std::max(0, static_cast<int>(std::floor(time / lidar_.model().period() + 1e-9)));
}

Time Recording::Stamp(double seconds) const {
  return Time::FromNanoseconds(Time::FromSeconds(config_.suite.epoch_s).nanoseconds() +
                               Time::FromSeconds(seconds).nanoseconds());
}

Scan Recording::MakeScan(int index) const {
  const double start_s = ScanStart(index);
  const Pose T_body_lidar = rig_.T_body_lidar();
  Scan scan = lidar_.Sweep(start_s, [this, &T_body_lidar](double time_s) -> Pose {
    return motion_->At(time_s).T_world_body * T_body_lidar;
  });
  scan.stamp = Stamp(start_s);
  return scan;
}

void Recording::Stream(int threads, const Sink& sink, const Progress& progress) const {
  const Pose T_body_imu = rig_.T_body_imu();
  ImuSimulator imu(config_.suite.imu, static_cast<std::uint32_t>(config_.seed) + 0x1A40U);
  std::int64_t imu_index = 0;
  const auto send_imu_until = [&](double end_s) {
    for (;; ++imu_index) {
      const double time_s = static_cast<double>(imu_index) / config_.suite.imu.rate_hz;
      if (time_s > end_s) return;
      const MotionState state = Attached(motion_->At(time_s), T_body_imu);
      const Time stamp = Stamp(time_s);
      sink({stamp, stamp, imu.Measure(IdealImu(stamp, state))});
    }
  };

  // While one scan is written, the next one is cast.
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(std::max(1, threads)));
  const auto launch = threads > 1 ? std::launch::async : std::launch::deferred;
  std::deque<std::future<Scan>> pending;
  const int scans = scan_count();
  int started = 0;
  for (int index = 0; index < scans; ++index) {
    for (; started < scans && started <= index + 1; ++started) {
      pending.push_back(std::async(launch, &Recording::MakeScan, this, started));
    }
    Scan scan = pending.front().get();
    pending.pop_front();
    const double arrival_s = ScanStart(index) + lidar_.model().period();
    send_imu_until(arrival_s);
    const Time stamp = scan.stamp;
    sink({Stamp(arrival_s), stamp, std::move(scan)});
    if (progress) progress(static_cast<double>(index + 1) / scans);
  }
  send_imu_until(config_.motion.duration_s);
}

Trajectory Recording::ImuTruth(const std::vector<Time>& also_at) const {
  return Truth(rig_.T_body_imu(), also_at);
}

Trajectory Recording::BaseTruth() const { return Truth(rig_.T_body_base, {}); }

Trajectory Recording::Truth(const Pose& T_body_frame, const std::vector<Time>& also_at) const {
  std::vector<StampedPose> poses;
  const Time epoch = Stamp(0.0);
  const auto add = [&](Time stamp) {
    poses.push_back({stamp, motion_->At(stamp - epoch).T_world_body * T_body_frame});
  };
  const auto count = static_cast<int>(config_.motion.duration_s * kTruthRateHz + 1e-9);
  for (int k = 0; k <= count; ++k) add(Stamp(k / kTruthRateHz));
  for (const Time stamp : also_at) add(stamp);
  return Trajectory(std::move(poses));
}

}  // namespace hv::sim
