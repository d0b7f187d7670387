#include "hv_navigation/footprint.h"

#include <algorithm>
#include <cmath>

namespace hv::navigation {

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
  // The distance is that of the centre of a cell, half a diagonal away at most.
  const double clearance_m = grid.ClearanceAt(pose.position);
  const double rounding_m = M_SQRT1_2 * grid.grid().resolution_m;
  if (clearance_m - rounding_m > CircumscribedRadius()) return false;
  if (clearance_m + rounding_m < InscribedRadius()) return true;
  const double step_m = 0.5 * grid.grid().resolution_m;
  const double width_m = half_width_m + margin_m;
  const auto along = static_cast<int>(std::ceil((front_m + back_m + 2.0 * margin_m) / step_m));
  const auto across = static_cast<int>(std::ceil(2.0 * width_m / step_m));
  for (int i = 0; i <= along; ++i) {
    const double x = -back_m - margin_m + (front_m + back_m + 2.0 * margin_m) * i / along;
    for (int k = 0; k <= across; ++k) {
      const double y = -width_m + 2.0 * width_m * k / across;
      if (grid.OccupiedAt(pose * Eigen::Vector2d(x, y))) return true;
    }
  }
  return false;
}

}  // namespace hv::navigation
