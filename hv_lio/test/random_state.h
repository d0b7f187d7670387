#pragma once

#include <random>

#include "hv_core/so3.h"
#include "hv_lio/nav_state.h"

namespace hv::lio {

inline Eigen::Vector3d RandomVector(std::mt19937& random, double sigma) {
  std::normal_distribution<double> normal(0.0, sigma);
  const double x = normal(random);
  const double y = normal(random);
  return {x, y, normal(random)};
}

inline NavState RandomState(std::mt19937& random) {
  NavState state;
  state.position = RandomVector(random, 5.0);
  state.rotation = so3::Exp(RandomVector(random, 1.0));
  state.velocity = RandomVector(random, 2.0);
  state.gyro_bias = RandomVector(random, 0.01);
  state.accel_bias = RandomVector(random, 0.1);
  state.gravity = so3::Exp(RandomVector(random, 0.2)) * Eigen::Vector3d(0.0, 0.0, -9.80665);
  return state;
}

inline ErrorVector RandomError(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  ErrorVector delta;
  for (int i = 0; i < kErrorDim; ++i) delta[i] = uniform(random);
  return delta;
}

}  // namespace hv::lio
