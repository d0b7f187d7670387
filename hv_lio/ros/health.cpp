#include "health.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "hv_core/elapsed.h"
#include "hv_core/memory.h"

namespace hv::lio {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr double kRateWindow = 2.0;  // [s]

std::string ToText(const Eigen::Vector3d& v) {
  char text[96];
  std::snprintf(text, sizeof(text), "%.5f %.5f %.5f", v.x(), v.y(), v.z());
  return text;
}

std::string ToText(const std::vector<Eigen::Vector3d>& directions) {
  std::string text;
  for (const Eigen::Vector3d& direction : directions) {
    text += (text.empty() ? "(" : ", (") + ToText(direction) + ")";
  }
  return text.empty() ? "none" : text;
}

/// Angle between the estimated gravity and straight down in odom [deg].
double TiltDegrees(const Eigen::Vector3d& gravity) {
  if (gravity.norm() == 0.0) return 0.0;
  return std::acos(std::clamp(-gravity.z() / gravity.norm(), -1.0, 1.0)) * 180.0 / M_PI;
}

}  // namespace

void RateMeter::Add(Time stamp) {
  if (!stamps_.empty() && stamp < stamps_.back()) stamps_.clear();
  stamps_.push_back(stamp);
  while (stamp - stamps_.front() > kRateWindow) stamps_.pop_front();
}

double RateMeter::hz() const {
  if (stamps_.size() < 2) return 0.0;
  const double span = stamps_.back() - stamps_.front();
  return span > 0.0 ? static_cast<double>(stamps_.size() - 1) / span : 0.0;
}

void Health::OnImu(Time stamp) {
  const std::lock_guard<std::mutex> lock(mutex_);
  imu_rate_.Add(stamp);
}

void Health::OnCloud(Time stamp) {
  const std::lock_guard<std::mutex> lock(mutex_);
  cloud_rate_.Add(stamp);
}

void Health::OnScan(const ScanResult& result) {
  const std::lock_guard<std::mutex> lock(mutex_);
  any_scan_ = true;
  last_ = result;
  last_.deskewed.reset();
  scans_.Add(result.timing.total_ms());
}

void Health::OnPublished(const ScanResult& result) {
  const double latency_ms = MillisecondsSince(result.arrival);
  const std::lock_guard<std::mutex> lock(mutex_);
  latencies_.Add(latency_ms);
}

void Health::OnCounters(const EngineCounters& engine, const InputQueue::Counters& queue) {
  const std::lock_guard<std::mutex> lock(mutex_);
  engine_ = engine;
  queue_ = queue;
}

void Health::SetProblem(const std::string& problem) {
  const std::lock_guard<std::mutex> lock(mutex_);
  problem_ = problem;
}

void Health::Summarize(Status& status) const {
  if (!problem_.empty()) {
    status.summary(DiagnosticStatus::WARN, problem_);
  } else if (!any_scan_) {
    status.summary(DiagnosticStatus::WARN, "no complete scan yet");
  } else if (last_.status != ScanStatus::kTracking) {
    status.summary(DiagnosticStatus::WARN,
                   std::string(ToString(last_.status)) + ": " + last_.reason);
  } else if (last_.update.degenerate()) {
    status.summary(DiagnosticStatus::WARN, "tracking, some directions are not observed");
  } else {
    status.summary(DiagnosticStatus::OK, "tracking");
  }
}

void Health::DescribeOdometry(Status& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  Summarize(status);
  const OdometryEstimate& estimate = last_.estimate;
  status.add("status", any_scan_ ? ToString(last_.status) : "no scan");
  status.add("reason", last_.reason);
  status.add("residuals", last_.update.residuals);
  status.add("residuals against planes", last_.update.planar);
  status.addf("mean residual [m]", "%.4f", last_.update.mean_abs_residual_m);
  status.add("iterations", last_.update.iterations);
  status.add("degenerate translation (odom axes)", ToText(last_.update.degenerate_translation));
  status.add("degenerate rotation (imu axes)", ToText(last_.update.degenerate_rotation));
  status.addf("gravity norm [m/s^2]", "%.4f", estimate.gravity_odom.norm());
  status.addf("gravity tilt in odom [deg]", "%.3f", TiltDegrees(estimate.gravity_odom));
  status.add("gyroscope bias [rad/s]", ToText(estimate.gyro_bias));
  status.add("accelerometer bias [m/s^2]", ToText(estimate.accel_bias));
  status.add("position [m]", ToText(Eigen::Vector3d(estimate.T_odom_imu.translation())));
  status.addf("speed [m/s]", "%.3f", estimate.velocity_odom.norm());
}

std::size_t Health::Faults() const {
  const PipelineCounters& pipeline = engine_.pipeline;
  return engine_.decode.clouds_unusable + pipeline.scans_dropped + pipeline.imu_out_of_order +
         pipeline.imu_invalid + pipeline.imu_saturated + pipeline.imu_gaps + pipeline.clock_jumps +
         queue_.scans_dropped + queue_.imu_dropped;
}

void Health::DescribeInput(Status& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::size_t faults = Faults();
  if (faults > reported_faults_) {
    status.summaryf(DiagnosticStatus::WARN, "%zu new faults in the input",
                    faults - reported_faults_);
  } else {
    status.summary(DiagnosticStatus::OK, "no new faults");
  }
  reported_faults_ = faults;
  status.addf("points rate [Hz]", "%.2f", cloud_rate_.hz());
  status.addf("imu rate [Hz]", "%.2f", imu_rate_.hz());
  status.add("point time", engine_.time_layout);
  const PipelineCounters& pipeline = engine_.pipeline;
  status.add("scans", pipeline.scans);
  status.add("scans tracked", pipeline.scans_tracked);
  status.add("scans on imu only", pipeline.scans_imu_only);
  status.add("scans dropped", pipeline.scans_dropped);
  status.add("clouds unusable", engine_.decode.clouds_unusable);
  status.add("last unusable cloud", engine_.last_decode_error);
  status.add("points not finite", engine_.decode.points_not_finite);
  status.add("points with bad time", engine_.decode.points_bad_time);
  status.add("imu samples", pipeline.imu_samples);
  status.add("imu out of order", pipeline.imu_out_of_order);
  status.add("imu invalid", pipeline.imu_invalid);
  status.add("imu saturated", pipeline.imu_saturated);
  status.add("imu gaps", pipeline.imu_gaps);
  status.add("clock jumps", pipeline.clock_jumps);
  status.add("resets", pipeline.resets);
  status.add("queue: scans dropped", queue_.scans_dropped);
  status.add("queue: imu dropped", queue_.imu_dropped);
}

void Health::DescribeResources(Status& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const double mean = scans_.Mean_ms();
  const double period_ms = cloud_rate_.hz() > 0.0 ? 1e3 / cloud_rate_.hz() : 0.0;
  if (period_ms > 0.0 && mean > period_ms) {
    status.summaryf(DiagnosticStatus::WARN, "too slow: %.1f ms a scan, a scan each %.1f ms", mean,
                    period_ms);
  } else {
    status.summaryf(DiagnosticStatus::OK, "%.1f ms a scan", mean);
  }
  status.addf("scan time mean [ms]", "%.2f", mean);
  status.addf("scan time max [ms]", "%.2f", scans_.Quantile_ms(1.0));
  status.addf("scan time max since start [ms]", "%.2f", scans_.longest_ms());
  status.addf("scan to pose median [ms]", "%.2f", latencies_.Quantile_ms(0.5));
  status.addf("scan to pose 99th percentile [ms]", "%.2f", latencies_.Quantile_ms(0.99));
  status.addf("scan to pose max since start [ms]", "%.2f", latencies_.longest_ms());
  status.add("voxels", last_.voxels);
  status.addf("memory [MB]", "%.1f", ResidentMegabytes());
}

}  // namespace hv::lio
