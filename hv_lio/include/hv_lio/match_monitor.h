#pragma once

#include "hv_lio/lio_config.h"
#include "hv_lio/odometry_result.h"

namespace hv::lio {

/// Notices that scans do not belong to the map any more, as when the robot was carried away unseen:
/// scan after scan few points find a surface, and those far off it, against what was usual before.
/// Odometry would go astray then, and what it adds to the map with it. Not thread-safe.
class MatchMonitor {
 public:
  explicit MatchMonitor(const RobustnessConfig& config) : config_(config) {}

  /// Takes the next scan that was matched. True once `misfit_scans` in a row do not belong.
  bool IsLost(const UpdateSummary& update);

  /// Forgets what was usual.
  void Restart();

 private:
  bool Misfits(const UpdateSummary& update) const;

  RobustnessConfig config_;
  double usual_residuals_ = 0.0;
  double usual_distance_m_ = 0.0;
  int fitting_ = 0;     ///< scans that made what is usual
  int misfitting_ = 0;  ///< in a row
};

}  // namespace hv::lio
