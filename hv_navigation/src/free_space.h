#pragma once

#include <cmath>

#include "hv_navigation/clearance_grid.h"
#include "hv_navigation/footprint.h"
#include "hv_navigation/planar.h"

namespace hv::navigation {

/// What a differential drive does between two poses: it turns, drives straight ahead, and turns.
struct TurnDriveTurn {
  double heading = 0.0;     ///< of the drive [rad]
  double first_turn = 0.0;  ///< [rad], in [-pi, pi]
  double length_m = 0.0;
  double last_turn = 0.0;
};

TurnDriveTurn Between(const PlanarPose& from, const PlanarPose& to);

/// How much nearness to obstacles costs: a metre driven counts 1 + weight at the inscribed radius,
/// falling with the square to 1 at the radius plus `soft_m`.
struct NearnessCost {
  double weight = 1.0;
  double soft_m = 0.35;
};

/// Where the robot fits, and what driving there costs. Holds references; const methods may run
/// concurrently.
class FreeSpace {
 public:
  FreeSpace(const ClearanceGrid& grid, const Footprint& footprint, const NearnessCost& cost);

  /// Within `radius_m` of `position` the robot keeps `margin_m` only, which may be negative.
  void AllowNear(const Eigen::Vector2d& position, double radius_m, double margin_m);

  void SetCost(const NearnessCost& cost) { cost_ = cost; }

  const ClearanceGrid& grid() const { return grid_; }

  bool IsFree(const PlanarPose& pose) const;
  /// However it stands.
  bool IsFreeToTurn(const Eigen::Vector2d& position) const {
    return TurnIsFree({position, 0.0}, 2.0 * M_PI);
  }
  bool TurnIsFree(const PlanarPose& from, double turn) const;
  bool DriveIsFree(const PlanarPose& from, double length_m) const;
  bool MotionIsFree(const PlanarPose& from, const PlanarPose& to) const;

  /// The smallest distance to obstacles that the middle of the robot must keep at `position` [m].
  double NeededClearance(const Eigen::Vector2d& position) const;

  /// The distance at which the robot fits however it stands [m].
  double circumscribed_m() const { return circumscribed_m_; }

  /// What a metre costs above 1 at this clearance.
  double Nearness(double clearance_m) const;
  double DriveCost(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;

 private:
  const Footprint& At(const Eigen::Vector2d& position) const;
  /// How far around `position` the robot may move and turn freely, for sure; negative if not [m].
  double Roaming(const Eigen::Vector2d& position) const;

  const ClearanceGrid& grid_;
  Footprint footprint_;
  Footprint near_footprint_;
  Eigen::Vector2d near_ = Eigen::Vector2d::Zero();
  double near_radius_m_ = -1.0;
  NearnessCost cost_;
  double inscribed_m_;
  double circumscribed_m_ = 0.0;
};

}  // namespace hv::navigation
