#pragma once

#include <mutex>
#include <string>

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include "control_loop.h"
#include "mapping_worker.h"
#include "odometry_buffer.h"

namespace hv::navigation {

/// Fills the diagnostics of the navigation node from its parts. Thread-safe.
class NavigationHealth {
 public:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  /// All must outlive this object.
  NavigationHealth(const ControlLoop& control, const MappingWorker& mapping,
                   const OdometryBuffer& odometry);

  /// One line that overrides the state while not empty (nobody publishes scans).
  void SetProblem(const std::string& problem);

  /// State, reason, goals, cycles, age of the inputs.
  void DescribeNavigation(Status& status);
  /// Octree, times, counters of every fault.
  void DescribeMapping(Status& status);

 private:
  const ControlLoop& control_;
  const MappingWorker& mapping_;
  const OdometryBuffer& odometry_;
  std::mutex mutex_;  // guards everything below
  std::string problem_;
  std::size_t reported_faults_ = 0;
};

}  // namespace hv::navigation
