#pragma once

#include <cmath>

#include "hv_sim/motion.h"

namespace hv::sim {

/// A function of time at one instant with its first two derivatives; arithmetic applies the rules
/// of differentiation, so that compositions stay exact.
struct Jet {
  double value = 0.0;
  double first = 0.0;
  double second = 0.0;
};

inline Jet operator+(const Jet& a, const Jet& b) {
  return {a.value + b.value, a.first + b.first, a.second + b.second};
}

inline Jet operator-(const Jet& a, const Jet& b) {
  return {a.value - b.value, a.first - b.first, a.second - b.second};
}

inline Jet operator*(const Jet& a, const Jet& b) {
  return {a.value * b.value, a.first * b.value + a.value * b.first,
          a.second * b.value + 2.0 * a.first * b.first + a.value * b.second};
}

inline Jet Sin(const Jet& a) {
  const double sine = std::sin(a.value);
  const double cosine = std::cos(a.value);
  return {sine, cosine * a.first, cosine * a.second - sine * a.first * a.first};
}

inline Jet Cos(const Jet& a) {
  const double sine = std::sin(a.value);
  const double cosine = std::cos(a.value);
  return {cosine, -sine * a.first, -sine * a.second - cosine * a.first * a.first};
}

/// Attitude Rz(yaw) Ry(pitch) Rx(roll) with its angular velocity and acceleration.
void SetRotation(const Jet& roll, const Jet& pitch, const Jet& yaw, MotionState& state);

/// Position with velocity and acceleration.
void SetTranslation(const Jet& x, const Jet& y, const Jet& z, MotionState& state);

}  // namespace hv::sim
