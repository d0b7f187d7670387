#include "hv_navigation/footprint.h"

#include <algorithm>
#include <cmath>

namespace hv::navigation {
namespace {

/// An axis-aligned part of the footprint, in the frame of the base.
struct Part {
  Eigen::Vector2d center;
  Eigen::Vector2d half;
};

/// Decides by the distance at the centre, else looks at both halves.
class PartChecker {
 public:
  PartChecker(const ClearanceGrid& grid, const PlanarPose& pose)
      : grid_(grid),
        origin_(pose.position),
        x_(pose.Ahead()),
        y_(-x_.y(), x_.x()),
        cell_m_(grid.grid().resolution_m) {}

  bool Touches(const Part& part) const {
    const Eigen::Vector2d at = origin_ + part.center.x() * x_ + part.center.y() * y_;
    const double clearance_m = grid_.ClearanceAt(at);
    if (clearance_m <= 0.0) return true;
    // The distance is that of the centre of a cell, from a border taken to be half a cell away.
    if (clearance_m - cell_m_ > part.half.norm()) return false;
    if (part.half.maxCoeff() <= 0.25 * cell_m_) return false;
    const int axis = part.half.x() >= part.half.y() ? 0 : 1;
    Part low = part;
    low.half[axis] *= 0.5;
    Part high = low;
    low.center[axis] -= low.half[axis];
    high.center[axis] += high.half[axis];
    return Touches(low) || Touches(high);
  }

 private:
  const ClearanceGrid& grid_;
  Eigen::Vector2d origin_;
  Eigen::Vector2d x_;
  Eigen::Vector2d y_;
  double cell_m_;
};

}  // namespace

void Footprint::Describe(ConfigVisitor& visitor) {
  visitor.Field("front_m", front_m, "from the origin of the base to the front [m]");
  visitor.Field("back_m", back_m, "and to the back [m]");
  visitor.Field("half_width_m", half_width_m, "half the width [m]");
  visitor.Field("margin_m", margin_m, "kept free around the robot [m]");
}

void Footprint::Validate(ConfigProblems& problems) const {
  problems.Require(front_m > 0.0, "footprint.front_m", "must be positive");
  problems.Require(back_m > 0.0, "footprint.back_m", "must be positive");
  problems.Require(half_width_m > 0.0, "footprint.half_width_m", "must be positive");
  problems.Require(margin_m >= 0.0, "footprint.margin_m", "must not be negative");
}

double Footprint::InscribedRadius() const {
  return std::min({front_m, back_m, half_width_m}) + margin_m;
}

double Footprint::CircumscribedRadius() const {
  return std::hypot(std::max(front_m, back_m) + margin_m, half_width_m + margin_m);
}

bool Footprint::Collides(const ClearanceGrid& grid, const PlanarPose& pose) const {
  const double clearance_m = grid.ClearanceAt(pose.position);
  const double rounding_m = grid.grid().resolution_m;
  if (clearance_m - rounding_m > CircumscribedRadius()) return false;
  if (clearance_m + rounding_m < InscribedRadius()) return true;
  Part whole;
  whole.center = {0.5 * (front_m - back_m), 0.0};
  whole.half = {0.5 * (front_m + back_m) + margin_m, half_width_m + margin_m};
  return PartChecker(grid, pose).Touches(whole);
}

bool Footprint::CollidesTurning(const ClearanceGrid& grid, const PlanarPose& pose,
                                double turn) const {
  const double step = 0.5 * grid.grid().resolution_m / CircumscribedRadius();
  const int steps = static_cast<int>(std::ceil(std::abs(turn) / step));
  for (int i = 1; i <= steps; ++i) {
    if (Collides(grid, {pose.position, pose.yaw + turn * i / steps})) return true;
  }
  return false;
}

}  // namespace hv::navigation
