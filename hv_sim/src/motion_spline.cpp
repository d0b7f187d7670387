#include "motion_spline.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hv::sim {
namespace {

/// Row k: polynomial in u (ascending powers) that weighs control floor(t / step) - 2 + k.
Eigen::Matrix<double, 6, 6> QuinticBasis() {
  Eigen::Matrix<double, 6, 6> basis;
  basis << 1, -5, 10, -10, 5, -1,   //
      26, -50, 20, 20, -20, 5,      //
      66, 0, -60, 0, 30, -10,       //
      26, 50, 20, -20, -20, 10,     //
      1, 5, 10, 10, 5, -5,          //
      0, 0, 0, 0, 0, 1;
  return basis / 120.0;
}

}  // namespace

QuinticWeights::QuinticWeights(double share, double step_s) {
  static const Eigen::Matrix<double, 6, 6> kBasis = QuinticBasis();
  const double u = share;
  const double u2 = u * u;
  const double u3 = u2 * u;
  Weights powers;
  Weights powers_first;
  Weights powers_second;
  powers << 1.0, u, u2, u3, u2 * u2, u2 * u3;
  powers_first << 0.0, 1.0, 2.0 * u, 3.0 * u2, 4.0 * u3, 5.0 * u2 * u2;
  powers_second << 0.0, 0.0, 2.0, 6.0 * u, 12.0 * u2, 20.0 * u3;
  value = kBasis * powers;
  first = kBasis * powers_first / step_s;
  second = kBasis * powers_second / (step_s * step_s);
}

MotionSpline::MotionSpline(double step_s, std::vector<Controls> controls)
    : step_s_(step_s), controls_(std::move(controls)) {}

MotionSpline::Sample MotionSpline::At(double time_s) const {
  const double position = time_s / step_s_;
  const double knot = std::floor(position);
  const QuinticWeights weights(position - knot, step_s_);

  Sample sample{Controls::Zero(), Controls::Zero(), Controls::Zero()};
  const auto last = static_cast<double>(controls_.size() - 1);
  for (int k = 0; k < 6; ++k) {
    const auto index = static_cast<std::size_t>(std::clamp(knot - 2.0 + k, 0.0, last));
    sample.value += weights.value[k] * controls_[index];
    sample.first += weights.first[k] * controls_[index];
    sample.second += weights.second[k] * controls_[index];
  }
  return sample;
}

}  // namespace hv::sim
