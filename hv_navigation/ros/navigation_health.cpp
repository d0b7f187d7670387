#include "navigation_health.h"

#include <iomanip>
#include <sstream>

#include "hv_core/memory.h"

namespace hv::navigation {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr double kSlow_ms = 80.0;

std::string WithReason(const ControlState& control) {
  const std::string state = ToString(control.state);
  return control.reason.empty() ? state : state + ": " + control.reason;
}

std::string AgeText(double age_s) {
  constexpr double kNever_s = 1e8;
  std::ostringstream text;
  text << std::fixed << std::setprecision(3) << age_s;
  return age_s < kNever_s ? text.str() : "none yet";
}

void Summarize(const ControlState& control, NavigationHealth::Status& status) {
  const bool trouble = control.state == NavigationState::kWaiting ||
                       control.state == NavigationState::kTurning ||
                       control.state == NavigationState::kBackingOff;
  if (control.state == NavigationState::kPaused) {
    status.summary(DiagnosticStatus::ERROR, WithReason(control));
  } else if (!control.missing.empty()) {
    status.summary(DiagnosticStatus::WARN, WithReason(control) + "; " + control.missing);
  } else {
    status.summary(trouble ? DiagnosticStatus::WARN : DiagnosticStatus::OK, WithReason(control));
  }
  if (control.other_clock) {
    status.mergeSummary(DiagnosticStatus::WARN,
                        "sensors are stamped by another clock than that of "
                        "ROS: how late they are is not known");
  }
}

std::size_t Faults(const MappingCounters& counters, std::size_t odometry_refused) {
  return counters.scans_unusable + counters.images_unusable + counters.images_without_pose +
         odometry_refused;
}

}  // namespace

NavigationHealth::NavigationHealth(const ControlLoop& control, const MappingWorker& mapping,
                                   const OdometryBuffer& odometry)
    : control_(control), mapping_(mapping), odometry_(odometry) {}

void NavigationHealth::SetProblem(const std::string& problem) {
  const std::lock_guard<std::mutex> lock(mutex_);
  problem_ = problem;
}

void NavigationHealth::DescribeNavigation(Status& status) {
  const ControlState control = control_.state();
  Summarize(control, status);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!problem_.empty()) status.mergeSummary(DiagnosticStatus::ERROR, problem_);
  }
  status.add("state", ToString(control.state));
  status.add("reason", control.reason);
  status.add("missing input", control.missing);
  status.add("goal under way", control.has_goal);
  status.addf("way left [m]", "%.2f", control.remaining_m);
  status.add("recoveries since it got on", control.recoveries);
  status.add("place in the map known", control.localized);
  status.add("age of the pose [s]", AgeText(control.pose_age_s));
  status.add("age of the obstacles [s]", AgeText(control.obstacles_age_s));
  status.add("cycles", control.cycles);
  status.add("cycles missed", control.missed);
  status.addf("last cycle [ms]", "%.2f", control.cycle_ms);
  status.addf("longest cycle [ms]", "%.2f", control.longest_cycle_ms);
  const RecentDurations latencies = control_.latencies();
  status.addf("obstacles to velocity median [ms]", "%.1f", latencies.Quantile_ms(0.5));
  status.addf("obstacles to velocity 99th percentile [ms]", "%.1f", latencies.Quantile_ms(0.99));
  status.addf("obstacles to velocity max since start [ms]", "%.1f", latencies.longest_ms());
  status.add("goals", control.goals);
  status.add("goals reached", control.reached);
  status.add("last result", control.last_result);
}

void NavigationHealth::DescribeMapping(Status& status) {
  const MappingCounters counters = mapping_.counters();
  const std::size_t faults = Faults(counters, odometry_.refused());
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (faults > reported_faults_) {
      status.summary(DiagnosticStatus::WARN, counters.last_error);
    } else if (counters.scan_ms > kSlow_ms) {
      status.summary(DiagnosticStatus::WARN,
                     "slow: raise obstacle_map.voxel_m or lower its ranges");
    } else {
      status.summary(DiagnosticStatus::OK, counters.scans > 0 ? "mapping" : "no scan yet");
    }
    reported_faults_ = faults;
  }
  status.add("scans", counters.scans);
  status.add("scans without points", counters.scans_without_points);
  status.add("scans unusable", counters.scans_unusable);
  status.add("scans dropped", counters.queue.scans_dropped);
  status.add("depth images", counters.images);
  status.add("depth images unusable", counters.images_unusable);
  status.add("depth images without pose", counters.images_without_pose);
  status.add("depth images dropped", counters.queue.images_dropped);
  status.add("odometry unusable", odometry_.refused());
  status.add("last error", counters.last_error);
  status.add("octree nodes", counters.nodes);
  status.addf("last scan [ms]", "%.1f", counters.scan_ms);
  status.addf("longest scan [ms]", "%.1f", counters.longest_scan_ms);
  status.addf("last depth image [ms]", "%.1f", counters.image_ms);
  status.add("cells beyond the largest map", counters.cells_left_out);
  status.add("corrections that misplaced what was seen", counters.place_jumps);
  status.addf("memory [MB]", "%.1f", ResidentMegabytes());
}

}  // namespace hv::navigation
