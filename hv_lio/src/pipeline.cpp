#include "hv_lio/pipeline.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace hv::lio {
namespace {

LioConfig Checked(const LioConfig& config) {
  ConfigProblems problems;
  config.Validate(problems);
  if (!problems.lines().empty()) throw InputError("configuration: " + problems.lines().front());
  LioConfig effective = config;
  if (!config.use_imu) {
    effective.imu = ConstantVelocityModel(config.constant_velocity).Noise();
  }
  return effective;
}

std::string Line(const char* format, double value, const char* text) {
  char line[200];
  std::snprintf(line, sizeof(line), format, value, text);
  return line;
}

}  // namespace

Pipeline::Pipeline(const LioConfig& config)
    : config_(Checked(config)),
      odometry_(config_),
      initializer_(config_.initialization),
      constant_velocity_(config_.constant_velocity),
      imu_(config_.imu, config_.robustness.imu_gap_s),
      match_(config_.robustness) {}

const VoxelMap& Pipeline::map() const { return odometry_.map(); }

void Pipeline::Note(std::string event) { events_.push_back(std::move(event)); }

std::vector<std::string> Pipeline::TakeEvents() { return std::exchange(events_, {}); }

void Pipeline::AddImu(const ImuSample& sample) {
  ++counters_.imu_samples;
  if (!sample.acceleration.allFinite() || !sample.angular_velocity.allFinite()) {
    ++counters_.imu_invalid;
    return;
  }
  const std::optional<Time> newest = imu_.newest();
  if (newest && sample.stamp <= *newest) {
    if (*newest - sample.stamp > config_.robustness.clock_jump_s) {
      FollowClock(sample.stamp, "IMU");
    } else {
      ++counters_.imu_out_of_order;
    }
  }
  if (newest && sample.stamp - *newest > config_.robustness.imu_gap_s) {
    ++counters_.imu_gaps;
    Note(Line("IMU silent for %.3f s%s", sample.stamp - *newest, ""));
  }
  if (!imu_.Add(sample)) return;
  if (sample.angular_velocity.cwiseAbs().maxCoeff() >= config_.imu.gyro_limit ||
      sample.acceleration.cwiseAbs().maxCoeff() * odometry_.accel_scale() >=
          config_.imu.accel_limit) {
    ++counters_.imu_saturated;
  }
}

void Pipeline::AddScan(Scan scan, double decode_ms, std::chrono::steady_clock::time_point arrival) {
  ++counters_.scans;
  scan.stamp = scan.stamp + config_.lidar_time_offset_s;
  const auto later = [](Time stamp, const WaitingScan& waiting) {
    return stamp < waiting.scan.stamp;
  };
  const auto place = std::upper_bound(scans_.begin(), scans_.end(), scan.stamp, later);
  scans_.insert(place, {std::move(scan), decode_ms, arrival});
}

bool Pipeline::CoveredByImu(const Scan& scan) const {
  return !config_.use_imu || (imu_.newest() && *imu_.newest() >= scan.end());
}

std::optional<ScanResult> Pipeline::ProcessNext() {
  if (scans_.empty()) return std::nullopt;
  const bool overdue =
      scans_.size() > static_cast<std::size_t>(config_.robustness.max_waiting_scans);
  if (!CoveredByImu(scans_.front().scan) && !overdue) return std::nullopt;
  return ProcessOldest();
}

std::optional<ScanResult> Pipeline::Flush() {
  return scans_.empty() ? std::nullopt : std::optional<ScanResult>(ProcessOldest());
}

ScanResult Pipeline::ProcessOldest() {
  const WaitingScan waiting = std::move(scans_.front());
  scans_.pop_front();
  const Scan& scan = waiting.scan;
  ScanResult result;
  result.scan_start = scan.stamp;
  result.estimate.stamp = scan.end();
  if (odometry_.initialized()) {
    result = Track(scan);
  } else {
    TryStart(scan, result);
  }
  result.segment = static_cast<std::uint32_t>(counters_.segments());
  result.timing.preprocess_ms += waiting.decode_ms;
  result.arrival = waiting.arrival;
  if (result.status == ScanStatus::kDropped) ++counters_.scans_dropped;
  if (result.status == ScanStatus::kImuOnly) ++counters_.scans_imu_only;
  if (result.status == ScanStatus::kTracking) ++counters_.scans_tracked;
  return result;
}

void Pipeline::TryStart(const Scan& scan, ScanResult& result) {
  result.status = ScanStatus::kInitializing;
  if (scan.points.empty()) {
    result.reason = "waiting for a scan with points";
    return;
  }
  if (!config_.use_imu) {
    odometry_.Start(scan.stamp, constant_velocity_.Start());
    result = Track(scan);
    return;
  }
  for (const ImuSample& sample : imu_.samples()) {
    if (sample.stamp <= scan.end()) initializer_.Add(sample);
  }
  RememberForStart(scan);
  const std::optional<InitialState> initial = initializer_.TryInitialize();
  if (!initial) {
    result.reason = initializer_.WaitingFor();
    return;
  }
  if (initial->accel_scale != 1.0) Note("accelerometer reads g, not m/s^2: converted");
  if (initial->moving) {
    result = StartInMotion(StartWindow(initial->accel_scale), *initial, odometry_).back();
    Note("started in motion");
  } else {
    odometry_.Start(scan.end(), *initial);
    result = Track(scan);
    Note("started at rest");
  }
  ForgetStart();
}

void Pipeline::RememberForStart(const Scan& scan) {
  const auto limit = static_cast<std::size_t>(config_.initialization.moving_start_scans);
  if (!start_scans_.empty() && scan.end() <= start_scans_.back().end()) return;
  start_scans_.push_back(scan);
  while (start_scans_.size() > limit) start_scans_.pop_front();
  imu_.DropBefore(start_scans_.front().stamp);
}

std::vector<WindowScan> Pipeline::StartWindow(double accel_scale) const {
  std::vector<WindowScan> window;
  Time from = start_scans_.front().stamp;
  for (const Scan& scan : start_scans_) {
    window.push_back({scan, imu_.Steps(from, scan.end(), accel_scale)});
    from = scan.end();
  }
  return window;
}

void Pipeline::ForgetStart() {
  initializer_.Clear();
  start_scans_.clear();
}

std::vector<ImuStep> Pipeline::StepsTo(const Scan& scan) {
  const Time from = odometry_.stamp();
  if (!config_.use_imu) {
    return constant_velocity_.Steps(odometry_.state(), scan.end() - from);
  }
  return imu_.Steps(from, scan.end(), odometry_.accel_scale());
}

ScanResult Pipeline::Track(const Scan& scan) {
  const double lag = odometry_.stamp() - scan.end();
  if (lag > config_.robustness.clock_jump_s) FollowClock(scan.stamp, "LiDAR");
  const bool silent =
      imu_.LongestGap(odometry_.stamp(), scan.end()) > config_.robustness.clock_jump_s;
  if (scan.stamp - odometry_.stamp() > config_.robustness.clock_jump_s && silent) {
    FollowClock(scan.stamp, "sensor");
  }
  if (scan.end() < odometry_.stamp()) {
    ScanResult result;
    result.status = ScanStatus::kDropped;
    result.scan_start = scan.stamp;
    result.estimate.stamp = scan.end();
    result.reason = "scan is older than the one before";
    return result;
  }
  ScanResult result = odometry_.Process(scan, StepsTo(scan));
  imu_.DropBefore(scan.end());
  constant_velocity_.Observe(scan.end(), result.estimate.T_odom_imu.linear());
  Supervise(result);
  return result;
}

void Pipeline::FollowClock(Time stamp, const char* source) {
  ++counters_.clock_jumps;
  Note(Line("clock of the %2$s jumped by %1$.3f s", stamp - odometry_.stamp(), source));
  const auto belongs = [&](const WaitingScan& waiting) {
    const double distance = waiting.scan.stamp - stamp;
    return distance > -1.0 && distance < config_.robustness.clock_jump_s;
  };
  const auto foreign = std::remove_if(
      scans_.begin(), scans_.end(), [&](const WaitingScan& waiting) { return !belongs(waiting); });
  counters_.scans_dropped += static_cast<std::size_t>(scans_.end() - foreign);
  scans_.erase(foreign, scans_.end());
  if (imu_.newest() && *imu_.newest() > stamp + config_.robustness.clock_jump_s) imu_.Clear();
  ForgetStart();
  constant_velocity_.Clear();
  if (config_.robustness.on_clock_jump == "reset") {
    Reset(true);
  } else {
    odometry_.MoveClock(stamp);
  }
}

void Pipeline::Supervise(ScanResult& result) {
  imu_only_streak_ = result.status == ScanStatus::kImuOnly ? imu_only_streak_ + 1 : 0;
  const double speed = result.estimate.velocity_odom.norm();
  if (!(speed < config_.robustness.max_speed_mps)) {
    result.reason = Line("diverged: speed %.1f m/s%s", speed, ", started anew");
  } else if (imu_only_streak_ >= config_.robustness.max_imu_only_scans) {
    result.reason =
        Line("no match with the map for %.0f scans%s", imu_only_streak_, ", started anew");
  } else if (result.status == ScanStatus::kTracking && match_.IsLost(result.update)) {
    result.reason = Line("the last %.0f scans do not belong to the map%s",
                         config_.robustness.misfit_scans, ", started anew");
  } else {
    return;
  }
  result.status = ScanStatus::kImuOnly;
  Note(result.reason);
  Reset(true);
}

void Pipeline::Reset(bool keep_pose) {
  ++counters_.resets;
  odometry_.Reset(keep_pose);
  ForgetStart();
  constant_velocity_.Clear();
  imu_only_streak_ = 0;
  match_.Restart();
}

}  // namespace hv::lio
