#pragma once

#include <optional>

#include "hv_core/se3.h"

namespace hv::replay {

/// Makes the odometry worse than it is, to see what loop closing mends.
struct DriftRates {
  double share = 0.0;      ///< of the distance, along the way
  double deg_per_m = 0.0;  ///< of the heading, to the left
};

/// Adds drift to poses in order of time.
class DriftInjector {
 public:
  explicit DriftInjector(const DriftRates& rates) : rates_(rates) {}

  /// The pose with the drift gathered until here.
  Pose Apply(const Pose& T_odom_imu);

 private:
  DriftRates rates_;
  std::optional<Pose> last_;
  Pose drifted_ = Pose::Identity();
};

}  // namespace hv::replay
