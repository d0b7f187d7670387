#include "hv_replay/stream_figures.h"

#include <algorithm>
#include <cmath>

namespace hv::replay {
namespace {

/// Value below which `share` of `values` lie; 0 without values.
double NearestQuantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const double index = share * static_cast<double>(values.size() - 1);
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(std::lround(index));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

/// Samples of the quietest quarter by distance of the angular velocity from its median.
std::vector<double> QuietAccelerations(const std::vector<ImuSample>& samples) {
  Eigen::Vector3d typical;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const ImuSample& sample : samples) values.push_back(sample.angular_velocity[axis]);
    typical[axis] = NearestQuantile(std::move(values), 0.5);
  }
  std::vector<double> turning;
  for (const ImuSample& sample : samples) {
    turning.push_back((sample.angular_velocity - typical).norm());
  }
  const double limit = NearestQuantile(turning, 0.25);
  std::vector<double> norms;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (turning[i] <= limit) norms.push_back(samples[i].acceleration.norm());
  }
  return norms;
}

/// Standard deviation of a vector quantity, all axes together.
double Spread(const std::vector<ImuSample>& samples, Eigen::Vector3d ImuSample::*quantity) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const ImuSample& sample : samples) mean += sample.*quantity;
  mean /= static_cast<double>(samples.size());
  double squares = 0.0;
  for (const ImuSample& sample : samples) squares += (sample.*quantity - mean).squaredNorm();
  return std::sqrt(squares / static_cast<double>(samples.size()));
}

bool StartsAtRest(const std::vector<ImuSample>& samples, double acceleration_norm) {
  std::vector<ImuSample> first;
  for (const ImuSample& sample : samples) {
    if (sample.stamp - samples.front().stamp < 1.0) first.push_back(sample);
  }
  return first.size() > 10 && Spread(first, &ImuSample::acceleration) < 0.04 * acceleration_norm &&
         Spread(first, &ImuSample::angular_velocity) < 0.05;
}

}  // namespace

StreamFigures SummarizeStream(const std::vector<Time>& stamps, const std::vector<Time>& arrivals) {
  StreamFigures figures;
  figures.count = stamps.size();
  std::vector<double> intervals, latencies;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    latencies.push_back(arrivals[i] - stamps[i]);
    if (i > 0) intervals.push_back(stamps[i] - stamps[i - 1]);
  }
  figures.latency_s = NearestQuantile(std::move(latencies), 0.5);
  figures.median_interval_s = NearestQuantile(intervals, 0.5);
  if (figures.median_interval_s > 0.0) figures.rate_hz = 1.0 / figures.median_interval_s;
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    const double interval = intervals[i];
    if (interval < 0.0) ++figures.unsorted;
    if (interval == 0.0) ++figures.duplicates;
    if (interval > 1.5 * figures.median_interval_s) ++figures.gaps;
    figures.longest_step_back_s = std::max(figures.longest_step_back_s, -interval);
    if (interval > figures.longest_gap_s) {
      figures.longest_gap_s = interval;
      figures.longest_gap_at_s = stamps[i] - stamps.front();
    }
  }
  return figures;
}

ImuFigures SummarizeImu(const std::vector<ImuSample>& samples) {
  ImuFigures figures;
  std::vector<ImuSample> usable;
  std::vector<double> rates;
  for (const ImuSample& sample : samples) {
    if (!sample.acceleration.allFinite() || !sample.angular_velocity.allFinite()) {
      ++figures.not_finite;
    } else if (sample.acceleration.isZero() && sample.angular_velocity.isZero()) {
      ++figures.all_zero;
    } else {
      usable.push_back(sample);
      rates.push_back(sample.angular_velocity.norm());
    }
  }
  if (usable.empty()) return figures;
  figures.acceleration_norm = NearestQuantile(QuietAccelerations(usable), 0.5);
  const double norm = figures.acceleration_norm;
  figures.in_g = norm > 0.8 && norm < 1.25;
  figures.gravity_plausible = figures.in_g || (norm > 8.8 && norm < 10.8);
  figures.gyro_peak = NearestQuantile(std::move(rates), 0.999);
  figures.starts_at_rest = StartsAtRest(usable, norm);
  return figures;
}

}  // namespace hv::replay
