#pragma once

#include <string>
#include <vector>

#include "hv_core/point_cloud_decoder.h"

namespace hv {

/// Values of a time field: value i is `base + offset[i]`, in counts of an unknown unit. Kept apart
/// because an absolute count of nanoseconds does not fit a double.
struct PointTimes {
  long double base = 0.0L;
  std::vector<double> offset;
};

/// Where a cloud's times start and which of its points have usable times.
struct ResolvedTimes {
  Time zero;                 ///< instant that `seconds` count from
  std::vector<char> usable;  ///< per point
  std::vector<double> seconds;
};

/// Names searched for when the configuration says "auto", in order.
const std::vector<std::string>& PointTimeFieldNames();

/// Decides unit, reference and header convention from one cloud's times; nullopt when they cannot
/// be those of a sweep (too few, constant, or of no plausible span).
std::optional<PointTimeLayout> JudgePointTimes(const PointTimes& times, Time header,
                                               const PointCloudDecoderConfig& config);

/// Applies a layout. Times that are not finite or further than two scan periods from the median
/// are unusable; `seconds` count from the first usable firing, whose instant is `zero`.
ResolvedTimes ResolvePointTimes(const PointTimes& times, Time header, const PointTimeLayout& layout,
                                double scan_period_s);

/// Times rebuilt from the azimuth of points [rad] given in firing order or ring by ring.
ResolvedTimes TimesFromAzimuth(const std::vector<float>& azimuth, Time header,
                               const PointTimeLayout& layout, double scan_period_s);

}  // namespace hv
