#include "point_time.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace hv {
namespace {

constexpr double kPi = 3.14159265358979323846;
/// Fewer times than this say nothing about unit or reference.
constexpr std::size_t kMinJudgedPoints = 64;
/// Times are sampled to this number for robust statistics.
constexpr std::size_t kMaxSamples = 1024;
/// Shortest and longest plausible span of a cloud, in scan periods.
constexpr double kMinSpanPeriods = 0.04;
constexpr double kMaxSpanPeriods = 3.0;
/// An absolute time further than this from the header is of another clock [s].
constexpr double kSameClock = 1.0;

struct TimeUnit {
  const char* name;
  double seconds;
};
constexpr TimeUnit kUnits[] = {{"s", 1.0}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}};

/// Sorted sample of the finite offsets.
std::vector<double> SortedSample(const std::vector<double>& offsets) {
  const std::size_t step = offsets.size() / kMaxSamples + 1;
  std::vector<double> sample;
  sample.reserve(offsets.size() / step + 1);
  for (std::size_t i = 0; i < offsets.size(); i += step) {
    if (std::isfinite(offsets[i])) sample.push_back(offsets[i]);
  }
  std::sort(sample.begin(), sample.end());
  return sample;
}

double Quantile(const std::vector<double>& sorted, double fraction) {
  const double index = fraction * static_cast<double>(sorted.size() - 1);
  return sorted[static_cast<std::size_t>(std::lround(index))];
}

/// Unit in which `span` counts come closest to a scan period; 0 when none does.
double UnitFromSpan(double span, const PointCloudDecoderConfig& config) {
  for (const TimeUnit& unit : kUnits) {
    if (config.time_unit != "auto" && config.time_unit != unit.name) continue;
    const double periods = span * unit.seconds / config.scan_period_s;
    if (periods >= kMinSpanPeriods && periods <= kMaxSpanPeriods) return unit.seconds;
  }
  return 0.0;
}

/// Instant of a count; nullopt beyond the range of Time.
std::optional<Time> ToTime(long double count, double unit_s) {
  const long double nanoseconds = count * std::round(static_cast<long double>(unit_s) * 1e9L);
  if (!(std::abs(nanoseconds) < 9.2e18L)) return std::nullopt;
  return Time::FromNanoseconds(std::llround(nanoseconds));
}

const char* UnitName(double unit_s) {
  for (const TimeUnit& unit : kUnits) {
    if (unit.seconds == unit_s) return unit.name;
  }
  return "?";
}

double FirstUsable(const ResolvedTimes& resolved) {
  double first = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < resolved.seconds.size(); ++i) {
    if (resolved.usable[i] != 0) first = std::min(first, resolved.seconds[i]);
  }
  return std::isfinite(first) ? first : 0.0;
}

double LastUsable(const ResolvedTimes& resolved) {
  double last = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < resolved.seconds.size(); ++i) {
    if (resolved.usable[i] != 0) last = std::max(last, resolved.seconds[i]);
  }
  return std::isfinite(last) ? last : 0.0;
}

/// Shifts `resolved.seconds` so that the first usable one is 0, moving `zero` along.
void StartAtFirstFiring(ResolvedTimes& resolved) {
  const double first = FirstUsable(resolved);
  for (double& seconds : resolved.seconds) seconds -= first;
  resolved.zero = resolved.zero + first;
}

/// Instant at which the seconds of a header-referenced layout are 0.
Time HeaderZero(const ResolvedTimes& resolved, Time header, const PointTimeLayout& layout) {
  if (layout.stamp_at_end) {
    return layout.negative ? header : header - LastUsable(resolved);
  }
  const bool from_header = !layout.negative && !layout.other_clock;
  return from_header ? header : header - FirstUsable(resolved);
}

float WrapAngle(float angle) {
  constexpr float kTwoPi = static_cast<float>(2.0 * kPi);
  if (angle > static_cast<float>(kPi)) return angle - kTwoPi;
  return angle < -static_cast<float>(kPi) ? angle + kTwoPi : angle;
}

}  // namespace

const std::vector<std::string>& PointTimeFieldNames() {
  static const std::vector<std::string> kNames = {"t", "time", "timestamp", "offset_time",
                                                  "time_stamp"};
  return kNames;
}

std::optional<PointTimeLayout> JudgePointTimes(const PointTimes& times, Time header,
                                               const PointCloudDecoderConfig& config) {
  const std::vector<double> sample = SortedSample(times.offset);
  if (sample.size() < kMinJudgedPoints) return std::nullopt;
  const double first = Quantile(sample, 0.01);
  const double last = Quantile(sample, 0.99);
  PointTimeLayout layout;
  layout.unit_s = UnitFromSpan(last - first, config);
  if (layout.unit_s == 0.0) return std::nullopt;
  const long double middle = times.base + static_cast<long double>(Quantile(sample, 0.5));
  const long double middle_s = middle * static_cast<long double>(layout.unit_s);
  layout.absolute = std::abs(middle_s) > 3.0L * static_cast<long double>(config.scan_period_s);
  layout.negative = !layout.absolute && middle_s < 0.0L;
  layout.stamp_at_end = layout.negative;
  if (layout.absolute) {
    const std::optional<Time> start =
        ToTime(times.base + static_cast<long double>(first), layout.unit_s);
    if (!start) return std::nullopt;
    layout.clock_offset_s = header - *start;
    layout.other_clock = std::abs(layout.clock_offset_s) > kSameClock;
    const double span_s = (last - first) * layout.unit_s;
    layout.stamp_at_end = !layout.other_clock && layout.clock_offset_s > 0.5 * span_s;
  }
  if (config.header_stamp != "auto") layout.stamp_at_end = config.header_stamp == "end";
  return layout;
}

ResolvedTimes ResolvePointTimes(const PointTimes& times, Time header, const PointTimeLayout& layout,
                                double scan_period_s) {
  ResolvedTimes resolved;
  resolved.zero = header;
  resolved.usable.assign(times.offset.size(), 0);
  resolved.seconds.assign(times.offset.size(), 0.0);
  const std::vector<double> sample = SortedSample(times.offset);
  if (sample.empty()) return resolved;
  const double middle = Quantile(sample, 0.5);
  const double limit = 2.0 * scan_period_s / layout.unit_s;
  const std::optional<Time> middle_time =
      ToTime(times.base + static_cast<long double>(middle), layout.unit_s);
  const bool far = middle_time && std::abs(middle_time->seconds()) > 3.0 * scan_period_s;
  const bool contradicts = !middle_time || (far != layout.absolute) ||
                           (layout.absolute && !layout.other_clock &&
                            std::abs(*middle_time - header) > 10.0 * kSameClock);
  if (contradicts) return resolved;
  for (std::size_t i = 0; i < times.offset.size(); ++i) {
    const double after_middle = times.offset[i] - middle;
    if (!(std::abs(after_middle) <= limit)) continue;
    resolved.usable[i] = 1;
    resolved.seconds[i] = after_middle * layout.unit_s;
  }
  if (layout.absolute && !layout.other_clock) {
    resolved.zero = *middle_time;
  } else {
    const double to_count = static_cast<double>((times.base + static_cast<long double>(middle)) *
                                                static_cast<long double>(layout.unit_s));
    if (!layout.other_clock) {
      for (double& seconds : resolved.seconds) seconds += to_count;
    }
    resolved.zero = HeaderZero(resolved, header, layout);
  }
  StartAtFirstFiring(resolved);
  return resolved;
}

ResolvedTimes TimesFromAzimuth(const std::vector<float>& azimuth, Time header,
                               const PointTimeLayout& layout, double scan_period_s) {
  ResolvedTimes resolved;
  resolved.usable.assign(azimuth.size(), 1);
  resolved.seconds.assign(azimuth.size(), 0.0);
  resolved.zero = layout.stamp_at_end ? header - scan_period_s : header;
  if (azimuth.empty()) return resolved;
  double turned = 0.0;
  std::vector<double>& unwrapped = resolved.seconds;
  for (std::size_t i = 1; i < azimuth.size(); ++i) {
    turned += static_cast<double>(WrapAngle(azimuth[i] - azimuth[i - 1]));
    unwrapped[i] = turned;
  }
  const double direction = turned < 0.0 ? -1.0 : 1.0;
  const bool firing_order = std::abs(turned) < 3.0 * kPi;
  for (double& angle : unwrapped) {
    double turns = direction * angle / (2.0 * kPi);
    if (!firing_order) turns -= std::floor(turns);
    angle = std::clamp(turns, -0.1, 1.1) * scan_period_s;
  }
  const double first = FirstUsable(resolved);
  for (double& seconds : resolved.seconds) seconds -= first;
  return resolved;
}

std::string PointTimeLayout::ToString() const {
  if (deskewed) return "point time: none, clouds are taken as already deskewed at the header stamp";
  const std::string header =
      stamp_at_end ? "header stamp at the last point" : "header stamp at the first point";
  if (from_azimuth) {
    return "WARNING point time: no usable time field, REBUILT FROM AZIMUTH (less accurate), " +
           header;
  }
  const char* reference = absolute ? "absolute" : negative ? "relative to the end" : "relative";
  std::string text = "point time: field '" + field + "', " + reference + ", in " +
                     UnitName(unit_s) + ", " + header;
  if (other_clock) {
    char offset[120];
    std::snprintf(offset, sizeof(offset),
                  "; WARNING its clock is %.6g s behind the header's: header stamps are used",
                  clock_offset_s);
    text += offset;
  }
  return text;
}

}  // namespace hv
