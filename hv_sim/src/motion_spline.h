#pragma once

#include <vector>

#include <Eigen/Core>

namespace hv::sim {

/// What a plan prescribes at one instant: the path, the heading, the tilt of the ground, and how
/// lively the carrier moves.
enum Channel { kX, kY, kZ, kYaw, kPitch, kActivity, kChannels };
using Controls = Eigen::Matrix<double, kChannels, 1>;

/// How the six controls around an instant shape a uniform quintic B-spline and its derivatives.
struct QuinticWeights {
  using Weights = Eigen::Matrix<double, 6, 1>;
  Weights value;
  Weights first;   ///< [1/s]
  Weights second;  ///< [1/s^2]

  /// `share` in [0, 1) of the way from the third control to the fourth, which are `step_s` apart.
  QuinticWeights(double share, double step_s);
};

/// Uniform quintic B-spline over time: four times continuously differentiable, and constant
/// wherever six neighbouring controls agree. Immutable.
class MotionSpline {
 public:
  struct Sample {
    Controls value;
    Controls first;
    Controls second;
  };

  /// Control k acts around time k * step_s. `controls` must not be empty; its ends extend for ever.
  MotionSpline(double step_s, std::vector<Controls> controls);

  Sample At(double time_s) const;

 private:
  double step_s_;
  std::vector<Controls> controls_;
};

}  // namespace hv::sim
