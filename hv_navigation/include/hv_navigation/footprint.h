#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "hv_core/config.h"
#include "hv_navigation/clearance_grid.h"
#include "hv_navigation/planar.h"

namespace hv::navigation {

/// The ground that a robot covers: a rectangle in its base frame.
struct Footprint {
  double front_m = 0.30;  ///< from the origin of the base
  double back_m = 0.30;
  double half_width_m = 0.25;
  double margin_m = 0.03;  ///< kept free around it

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;

  /// Of the largest circle about the origin inside, and the smallest one around it, with the margin
  /// [m].
  double InscribedRadius() const;
  double CircumscribedRadius() const;

  /// Whether the robot with its margin would touch an obstacle. Decided by the distances where
  /// these suffice, else cell by cell.
  bool Collides(const ClearanceGrid& grid, const PlanarPose& pose) const;

  /// The same for a turn on the spot by `turn` [rad], the pose before it left out.
  bool CollidesTurning(const ClearanceGrid& grid, const PlanarPose& pose, double turn) const;
};

}  // namespace hv::navigation
