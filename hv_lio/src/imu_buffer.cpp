#include "hv_lio/imu_buffer.h"

#include <algorithm>
#include <cmath>

namespace hv::lio {
namespace {

/// Longest step of the process model; longer intervals are divided.
constexpr double kLongestStep = 0.02;

bool Earlier(const ImuSample& sample, Time stamp) { return sample.stamp < stamp; }

}  // namespace

bool ImuBuffer::Add(const ImuSample& sample) {
  if (samples_.empty() || samples_.back().stamp < sample.stamp) {
    samples_.push_back(sample);
    return true;
  }
  const auto place = std::lower_bound(samples_.begin(), samples_.end(), sample.stamp, Earlier);
  if (place->stamp == sample.stamp) return false;
  samples_.insert(place, sample);
  return true;
}

std::optional<Time> ImuBuffer::newest() const {
  return samples_.empty() ? std::nullopt : std::optional<Time>(samples_.back().stamp);
}

ImuSample ImuBuffer::At(Time stamp) const {
  const auto after = std::lower_bound(samples_.begin(), samples_.end(), stamp, Earlier);
  ImuSample result = after == samples_.end() ? samples_.back() : *after;
  if (after != samples_.end() && after != samples_.begin()) {
    const ImuSample& before = *(after - 1);
    const double ratio = (stamp - before.stamp) / (after->stamp - before.stamp);
    result.angular_velocity =
        (1.0 - ratio) * before.angular_velocity + ratio * after->angular_velocity;
    result.acceleration = (1.0 - ratio) * before.acceleration + ratio * after->acceleration;
  }
  result.stamp = stamp;
  return result;
}

std::vector<ImuStep> ImuBuffer::Steps(Time from, Time to, double accel_scale) const {
  std::vector<ImuStep> steps;
  if (samples_.empty() || to <= from) return steps;
  ImuSample begin = At(from);
  auto next = std::upper_bound(samples_.begin(), samples_.end(), from,
                               [](Time stamp, const ImuSample& s) { return stamp < s.stamp; });
  Time before = next == samples_.begin() ? from : (next - 1)->stamp;
  for (; next != samples_.end() && next->stamp < to; ++next) {
    AppendSteps(begin, *next, next->stamp - before > gap_s_, steps);
    begin = *next;
    before = next->stamp;
  }
  const Time after = next == samples_.end() ? to : next->stamp;
  AppendSteps(begin, At(to), after - before > gap_s_, steps);
  for (ImuStep& step : steps) {
    step.acceleration *= accel_scale;
    const bool saturated = step.quality == ImuQuality::kMeasured && Saturated(step);
    if (saturated) step.quality = ImuQuality::kSaturated;
  }
  return steps;
}

void ImuBuffer::AppendSteps(const ImuSample& begin, const ImuSample& end, bool gap,
                            std::vector<ImuStep>& steps) const {
  const double duration = end.stamp - begin.stamp;
  if (duration <= 0.0) return;
  const int pieces = static_cast<int>(std::ceil(duration / kLongestStep));
  for (int piece = 0; piece < pieces; ++piece) {
    const double ratio = (piece + 0.5) / pieces;
    ImuStep step;
    step.angular_velocity =
        (1.0 - ratio) * begin.angular_velocity + ratio * end.angular_velocity;
    step.acceleration = (1.0 - ratio) * begin.acceleration + ratio * end.acceleration;
    step.dt = duration / pieces;
    step.quality = gap ? ImuQuality::kMissing : ImuQuality::kMeasured;
    steps.push_back(step);
  }
}

bool ImuBuffer::Saturated(const ImuStep& step) const {
  return step.angular_velocity.cwiseAbs().maxCoeff() >= noise_.gyro_limit ||
         step.acceleration.cwiseAbs().maxCoeff() >= noise_.accel_limit;
}

double ImuBuffer::LongestGap(Time from, Time to) const {
  double longest = 0.0;
  Time before = from;
  auto next = std::lower_bound(samples_.begin(), samples_.end(), from, Earlier);
  for (; next != samples_.end() && next->stamp < to; ++next) {
    longest = std::max(longest, next->stamp - before);
    before = next->stamp;
  }
  return std::max(longest, to - before);
}

void ImuBuffer::DropBefore(Time stamp) {
  while (samples_.size() > 1 && samples_[1].stamp <= stamp) samples_.pop_front();
}

}  // namespace hv::lio
