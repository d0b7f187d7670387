#pragma once

#include <deque>
#include <mutex>
#include <optional>

#include "hv_core/imu_sample.h"
#include "hv_lio/imu_propagation.h"
#include "hv_lio/nav_state.h"
#include "hv_lio/odometry_result.h"

namespace hv::lio {

/// Odometry at IMU rate: carries the latest scan's estimate forward through every IMU sample as it
/// arrives, without waiting for the scan that is being processed meanwhile. A new estimate replaces
/// the anchor and the samples after it are propagated again, so the output corrects itself by a
/// small step once a scan. Thread-safe.
class ImuPredictor {
 public:
  explicit ImuPredictor(const ImuNoiseConfig& noise) : noise_(noise) {}

  /// Adds a sample; returns the prediction at its stamp, or nullopt without an anchor, for samples
  /// out of order, and once the anchor is older than `kMaxPrediction`.
  std::optional<OdometryEstimate> Add(const ImuSample& sample);

  /// The estimate of a scan.
  void Anchor(const OdometryEstimate& estimate);

  /// Forgets anchor and samples (reset, clock jump).
  void Clear();

  static constexpr double kMaxPrediction = 2.0;  ///< [s]

 private:
  void Step(const ImuSample& sample);
  OdometryEstimate Prediction() const;

  const ImuNoiseConfig noise_;
  std::mutex mutex_;  // guards everything below
  std::deque<ImuSample> samples_;  // after the anchor, and the one before it
  std::optional<OdometryEstimate> anchor_;
  ImuSample last_;   // latest sample that `state_` includes
  NavState state_;   // at last_.stamp
};

}  // namespace hv::lio
