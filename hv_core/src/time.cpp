#include "hv_core/time.h"

#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace hv {
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1000000000;
constexpr double kMaxSeconds = 9.2e9;

}  // namespace

Time Time::FromSeconds(double seconds) {
  const double whole = std::floor(seconds);
  return Time(static_cast<std::int64_t>(whole) * kNanosecondsPerSecond +
              std::llround((seconds - whole) * 1e9));
}

Time operator+(Time time, double seconds) {
  return Time(time.nanoseconds_ + std::llround(seconds * 1e9));
}

std::string ToString(Time time) {
  const std::int64_t nanoseconds = time.nanoseconds();
  const std::int64_t magnitude = nanoseconds < 0 ? -nanoseconds : nanoseconds;
  char text[40];
  std::snprintf(text, sizeof(text), "%s%lld.%09lld", nanoseconds < 0 ? "-" : "",
                static_cast<long long>(magnitude / kNanosecondsPerSecond),
                static_cast<long long>(magnitude % kNanosecondsPerSecond));
  return text;
}

std::optional<Time> ParseTime(const std::string& text) {
  std::size_t at = 0;
  const bool negative = !text.empty() && text[0] == '-';
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) ++at;
  const std::size_t first_digit = at;
  std::int64_t whole = 0;
  while (at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) != 0) {
    if (whole > static_cast<std::int64_t>(kMaxSeconds)) return std::nullopt;
    whole = whole * 10 + (text[at++] - '0');
  }
  std::size_t digits = at - first_digit;
  std::int64_t fraction = 0;
  if (at < text.size() && text[at] == '.') {
    std::int64_t scale = kNanosecondsPerSecond / 10;
    for (++at; at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) != 0; ++at) {
      fraction += (text[at] - '0') * scale;
      scale /= 10;
      ++digits;
    }
  }
  if (digits == 0 || whole > static_cast<std::int64_t>(kMaxSeconds)) return std::nullopt;
  if (at < text.size()) {
    if (text[at] != 'e' && text[at] != 'E') return std::nullopt;
    char* end = nullptr;
    const double seconds = std::strtod(text.c_str(), &end);
    const bool usable = end == text.c_str() + text.size() && std::abs(seconds) <= kMaxSeconds;
    return usable ? std::optional<Time>(Time::FromSeconds(seconds)) : std::nullopt;
  }
  const std::int64_t nanoseconds = whole * kNanosecondsPerSecond + fraction;
  return Time::FromNanoseconds(negative ? -nanoseconds : nanoseconds);
}

}  // namespace hv
