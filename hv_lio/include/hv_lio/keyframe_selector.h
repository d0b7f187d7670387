#pragma once

#include <cstdint>
#include <optional>

#include "hv_core/keyframe.h"
#include "hv_lio/odometry_result.h"

namespace hv::lio {

/// Picks the key scans of the odometry: those that moved or turned enough since the last one. The
/// node and the offline tool share it, so that both build the same maps. Not thread-safe.
class KeyframeSelector {
 public:
  KeyframeSelector(double distance_m, double angle_deg)
      : distance_m_(distance_m), angle_deg_(angle_deg) {}

  /// The scan as a keyframe when it is one. Only tracked scans are.
  std::optional<Keyframe> Add(const ScanResult& result);

 private:
  bool FarFromLast(const Pose& T_odom_imu) const;

  double distance_m_;
  double angle_deg_;
  std::optional<Pose> last_;
  std::uint32_t segment_ = 0;
  std::uint32_t next_id_ = 0;
};

}  // namespace hv::lio
