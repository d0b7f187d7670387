#include "hv_lio/odometry_result.h"

namespace hv::lio {

const char* ToString(ScanStatus status) {
  switch (status) {
    case ScanStatus::kInitializing:
      return "initializing";
    case ScanStatus::kTracking:
      return "tracking";
    case ScanStatus::kImuOnly:
      return "imu_only";
    case ScanStatus::kDropped:
      return "dropped";
  }
  return "unknown";
}

}  // namespace hv::lio
