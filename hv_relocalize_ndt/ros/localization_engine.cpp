#include "localization_engine.h"

#include <chrono>

#include "hv_core/pose_covariance.h"

namespace hv::relocalize {
namespace {

/// No LiDAR sees farther [m].
constexpr float kFarthest = 1000.0F;

TrackedScan ScanOf(const TrackedScanHeader& header, const std::vector<Point>& points) {
  TrackedScan scan;
  scan.stamp = header.stamp;
  scan.T_odom_imu = header.T_odom_imu;
  scan.segment = header.segment;
  scan.lidar_in_imu = header.lidar_in_imu;
  scan.points.reserve(points.size());
  for (const Point& point : points) {
    const Eigen::Vector3f position(point.x, point.y, point.z);
    if (position.cwiseAbs().maxCoeff() < kFarthest) scan.points.push_back(position);
  }
  return scan;
}

}  // namespace

LocalizationEngine::LocalizationEngine(const LocalizerConfig& config, const std::string& map_path)
    : map_(PriorMap::Load(map_path, config.relocalize)), localizer_(config, map_) {}

LocalizationReport LocalizationEngine::Add(const ScanBatch& batch) {
  const auto start = std::chrono::steady_clock::now();
  LocalizationReport report;
  report.scan = batch.header;
  report.update = Localize(batch);
  report.T_map_base = report.update.T_map_imu * batch.header.T_imu_base;
  report.covariance = CovarianceInMapAxes(report.update.T_map_imu, report.update.covariance,
                                          batch.header.T_imu_base);
  report.elapsed_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  Note(report);
  return report;
}

LocalizerUpdate LocalizationEngine::Localize(const ScanBatch& batch) {
  for (const TrackedScanHeader& header : batch.skipped) localizer_.Skip(ScanOf(header, {}));
  if (batch.points.empty()) return localizer_.Wait(batch.header.stamp);
  Begin(batch.header);
  return localizer_.Add(ScanOf(batch.header, batch.points));
}

/// Hands on what has been asked for.
void LocalizationEngine::Begin(const TrackedScanHeader& scan) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (request_.forget) localizer_.Forget();
  if (request_.guess) {
    PoseGuess guess = *request_.guess;
    guess.T_map_scan = guess.T_map_scan * scan.T_imu_base.inverse();
    localizer_.SetGuess(guess);
  }
  request_ = Request();
  begun_ = requests_;
}

void LocalizationEngine::Note(const LocalizationReport& report) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const LocalizerUpdate& update = report.update;
  const bool was_lost = state_.last.update.state == LocalizerState::kLost;
  ++state_.scans;
  if (!was_lost && update.state == LocalizerState::kLost) ++state_.losses;
  state_.last = report;
  if (!update.registered) return;
  state_.compared = update;
  ++(update.searched ? state_.searches : state_.comparisons);
  (update.searched ? state_.search_ms : state_.comparison_ms) = report.elapsed_ms;
  if (!update.searched || begun_ == done_) return;
  done_ = begun_;
  answer_ = report;
  answered_.notify_all();
}

void LocalizationEngine::SetGuess(const PoseGuess& guess) {
  const std::lock_guard<std::mutex> lock(mutex_);
  request_.guess = guess;
}

std::uint64_t LocalizationEngine::Relocalize(const std::optional<PoseGuess>& guess) {
  const std::lock_guard<std::mutex> lock(mutex_);
  request_ = {guess, true};
  return ++requests_;
}

bool LocalizationEngine::HasBegun(std::uint64_t number) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return begun_ >= number;
}

std::optional<LocalizationReport> LocalizationEngine::Answer(std::uint64_t number, double seconds) {
  std::unique_lock<std::mutex> lock(mutex_);
  const std::chrono::duration<double> patience(seconds);
  if (!answered_.wait_for(lock, patience, [&] { return done_ >= number; })) return std::nullopt;
  return answer_;
}

void LocalizationEngine::Cancel(std::uint64_t number) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (number == requests_ && begun_ < number) request_ = Request();
}

LocalizationState LocalizationEngine::state() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return state_;
}

}  // namespace hv::relocalize
