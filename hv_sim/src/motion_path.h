#pragma once

#include <vector>

#include <Eigen/Core>

#include "hv_sim/world.h"

namespace hv::sim {

/// A way that can be driven without standing still: equidistant points with rounded corners.
struct PathRun {
  static constexpr double kSpacing = 0.05;  ///< arc length between points [m]
  std::vector<Eigen::Vector3d> points;
  std::vector<double> yaw;        ///< heading, without jumps of 2 pi [rad]
  std::vector<double> curvature;  ///< [1/m]
  std::vector<double> slope;      ///< rise over arc length

  double length() const { return kSpacing * static_cast<double>(points.size() - 1); }
};

/// Unrolls the route to at least `length` [m] (laps when closed, back and forth when open), rounds
/// its corners by at most `corner` [m] along each leg, and cuts it where it reverses.
std::vector<PathRun> MakePath(const World& world, double length, double corner);

}  // namespace hv::sim
