#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace hv {

/// Instant on the sensor clock: whole nanoseconds since the epoch, so that absolute stamps keep
/// their precision. Differences are seconds.
class Time {
 public:
  constexpr Time() = default;
  static constexpr Time FromNanoseconds(std::int64_t nanoseconds) { return Time(nanoseconds); }
  /// Rounds to the nearest nanosecond; `seconds` must be finite and within +-9.2e9.
  static Time FromSeconds(double seconds);

  constexpr std::int64_t nanoseconds() const { return nanoseconds_; }
  constexpr double seconds() const { return static_cast<double>(nanoseconds_) * 1e-9; }

  /// Elapsed seconds from `b` to `a`.
  friend constexpr double operator-(Time a, Time b) {
    return static_cast<double>(a.nanoseconds_ - b.nanoseconds_) * 1e-9;
  }
  friend Time operator+(Time time, double seconds);
  friend Time operator-(Time time, double seconds) { return time + (-seconds); }

  friend constexpr bool operator==(Time a, Time b) { return a.nanoseconds_ == b.nanoseconds_; }
  friend constexpr bool operator!=(Time a, Time b) { return a.nanoseconds_ != b.nanoseconds_; }
  friend constexpr bool operator<(Time a, Time b) { return a.nanoseconds_ < b.nanoseconds_; }
  friend constexpr bool operator>(Time a, Time b) { return a.nanoseconds_ > b.nanoseconds_; }
  friend constexpr bool operator<=(Time a, Time b) { return a.nanoseconds_ <= b.nanoseconds_; }
  friend constexpr bool operator>=(Time a, Time b) { return a.nanoseconds_ >= b.nanoseconds_; }

 private:
  explicit constexpr Time(std::int64_t nanoseconds) : nanoseconds_(nanoseconds) {}
  std::int64_t nanoseconds_ = 0;
};

/// Decimal seconds with exactly nine digits, as written in TUM files.
std::string ToString(Time time);

/// Parses decimal seconds ("1646310000.123456789", "12", "-0.5") without going through floating
/// point; exponents are accepted and do. Nullopt when `text` is not a number or out of range.
std::optional<Time> ParseTime(const std::string& text);

}  // namespace hv
