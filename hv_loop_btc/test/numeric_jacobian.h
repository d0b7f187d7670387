#pragma once

#include <functional>
#include <random>
#include <vector>

#include <Eigen/Core>

#include "hv_core/se3.h"

namespace hv::loop {

/// Central differences of `function` by the right-multiplied perturbation of `pose`.
inline Eigen::Matrix<double, Eigen::Dynamic, 6> NumericJacobian(
    const std::function<Eigen::VectorXd(const Pose&)>& function, const Pose& pose) {
  constexpr double kStep = 1e-6;
  Eigen::Matrix<double, Eigen::Dynamic, 6> jacobian(function(pose).size(), 6);
  for (int k = 0; k < 6; ++k) {
    const Vector6d step = kStep * Vector6d::Unit(k);
    jacobian.col(k) =
        (function(pose * se3::Exp(step)) - function(pose * se3::Exp(-step))) / (2.0 * kStep);
  }
  return jacobian;
}

/// Tangent vectors: zero, tiny and random ones.
inline std::vector<Vector6d> SampleTangents(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Vector6d> tangents = {Vector6d::Zero()};
  for (const double scale : {1e-9, 1e-5, 1e-2, 0.5, 0.5, 0.5}) {
    Vector6d tangent;
    for (int k = 0; k < 6; ++k) tangent[k] = scale * normal(random);
    tangents.push_back(tangent);
  }
  return tangents;
}

}  // namespace hv::loop
