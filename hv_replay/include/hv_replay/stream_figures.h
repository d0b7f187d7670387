#pragma once

#include <cstddef>
#include <vector>

#include "hv_core/imu_sample.h"
#include "hv_core/time.h"

namespace hv::replay {

/// Timing of one stream of messages.
struct StreamFigures {
  std::size_t count = 0;
  double rate_hz = 0.0;  ///< from the median interval
  double median_interval_s = 0.0;
  std::size_t gaps = 0;  ///< intervals above 1.5 times the median
  double longest_gap_s = 0.0;
  double longest_gap_at_s = 0.0;  ///< after the first stamp
  std::size_t unsorted = 0;       ///< stamps earlier than the one before
  std::size_t duplicates = 0;     ///< stamps equal to the one before
  double longest_step_back_s = 0.0;
  double latency_s = 0.0;  ///< median of arrival minus stamp
};

/// `stamps` in order of arrival; `arrivals` of the same length.
StreamFigures SummarizeStream(const std::vector<Time>& stamps, const std::vector<Time>& arrivals);

/// What IMU readings look like.
struct ImuFigures {
  double acceleration_norm = 0.0;  ///< median at quiet moments, in the unit of the message
  bool in_g = false;               ///< norm is about 1
  bool gravity_plausible = false;  ///< norm is about 1 or about 9.81
  double gyro_peak = 0.0;          ///< 99.9th percentile of the norm, in the unit of the message
  std::size_t not_finite = 0;
  std::size_t all_zero = 0;
  bool starts_at_rest = false;  ///< gyroscope and accelerometer hardly vary in the first second
};

ImuFigures SummarizeImu(const std::vector<ImuSample>& samples);

}  // namespace hv::replay
