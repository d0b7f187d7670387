#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "hv_core/imu_sample.h"
#include "hv_lio/imu_propagation.h"

namespace hv::lio {

/// IMU samples in time order, and the propagation steps between two instants cut from them.
class ImuBuffer {
 public:
  /// Longer silences than `gap_s` are bridged by steps marked missing.
  ImuBuffer(const ImuNoiseConfig& noise, double gap_s) : noise_(noise), gap_s_(gap_s) {}

  /// Inserts in time order; false for a duplicate stamp.
  bool Add(const ImuSample& sample);

  bool empty() const { return samples_.empty(); }
  const std::deque<ImuSample>& samples() const { return samples_; }
  std::optional<Time> newest() const;

  /// Steps whose durations add up to `to - from`. Readings are interpolated at both ends, averaged
  /// over each interval, and multiplied by `accel_scale` (acceleration); beyond the samples the
  /// nearest reading is held. Empty when there are no samples or `to <= from`.
  std::vector<ImuStep> Steps(Time from, Time to, double accel_scale) const;

  /// Longest silence between `from` and `to`, counting both ends [s].
  double LongestGap(Time from, Time to) const;

  /// Drops what is not needed for steps from `stamp` on.
  void DropBefore(Time stamp);
  void Clear() { samples_.clear(); }

 private:
  ImuSample At(Time stamp) const;
  void AppendSteps(const ImuSample& begin, const ImuSample& end, bool gap,
                   std::vector<ImuStep>& steps) const;
  bool Saturated(const ImuStep& step) const;

  ImuNoiseConfig noise_;
  double gap_s_;
  std::deque<ImuSample> samples_;
};

}  // namespace hv::lio
