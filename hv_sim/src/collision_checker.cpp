#include "hv_sim/collision_checker.h"

#include <cmath>

#include "planar_geometry.h"

namespace hv::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Rectangle FootprintOf(const RobotShape& shape) {
  return {{-shape.back_m, -shape.half_width_m}, {shape.front_m, shape.half_width_m}};
}

/// The part of a segment with z in [low, high]; false when there is none.
bool Clip(double low, double high, Vector3d& from, Vector3d& to) {
  if (from.z() > to.z()) std::swap(from, to);
  if (from.z() > high || to.z() < low) return false;
  const Vector3d along = to - from;
  if (to.z() > high) to = from + (high - from.z()) / along.z() * along;
  if (from.z() < low) from += (low - from.z()) / along.z() * along;
  return true;
}

double GapTo(const Capsule& capsule, const Pose& T_base_world, const RobotShape& shape) {
  const auto radius = static_cast<double>(capsule.radius);
  Vector3d from = T_base_world * Vector3d(capsule.from.cast<double>());
  Vector3d to = T_base_world * Vector3d(capsule.to.cast<double>());
  if (!Clip(shape.bottom_m, shape.top_m, from, to)) return std::numeric_limits<double>::infinity();
  const double gap = Distance(FootprintOf(shape), from.head<2>(), to.head<2>()) - radius;
  return std::max(0.0, gap);
}

}  // namespace

void RobotShape::Describe(ConfigVisitor& visitor) {
  visitor.Field("front_m", front_m, "from the origin of the base to the front [m]");
  visitor.Field("back_m", back_m, "and to the back [m]");
  visitor.Field("half_width_m", half_width_m, "half the width [m]");
  visitor.Field("bottom_m", bottom_m, "things up to this height are driven over [m]");
  visitor.Field("top_m", top_m, "height of the robot [m]");
}

void RobotShape::Validate(ConfigProblems& problems) const {
  problems.Require(front_m > 0.0, "shape.front_m", "must be positive");
  problems.Require(back_m > 0.0, "shape.back_m", "must be positive");
  problems.Require(half_width_m > 0.0, "shape.half_width_m", "must be positive");
  problems.Require(bottom_m > 0.0, "shape.bottom_m", "must be positive");
  problems.Require(top_m > bottom_m, "shape.top_m", "must be above bottom_m");
}

CollisionChecker::CollisionChecker(const RobotShape& shape, std::shared_ptr<const RayCaster> scene,
                                   std::vector<PersonPath> people)
    : shape_(shape), scene_(std::move(scene)), people_(std::move(people)) {}

Clearance CollisionChecker::At(const Pose& T_world_base, double time_s, double limit_m) const {
  return {StaticGap(T_world_base, limit_m), PersonGap(T_world_base.inverse(), time_s, limit_m)};
}

double CollisionChecker::StaticGap(const Pose& T_world_base, double limit_m) const {
  const Pose T_base_world = T_world_base.inverse();
  const Rectangle footprint = FootprintOf(shape_);
  const Vector3d half(0.5 * (shape_.front_m + shape_.back_m), shape_.half_width_m,
                      0.5 * (shape_.top_m - shape_.bottom_m));
  const Vector3d center(0.5 * (shape_.front_m - shape_.back_m), 0.0, shape_.bottom_m + half.z());
  const Vector3d reach = half + Vector3d(limit_m, limit_m, 0.0);
  double least = limit_m;
  scene_->VisitNear(T_world_base * center, reach.norm(), [&](const RayCaster::Triangle& corners) {
    std::array<Vector3d, 3> triangle;
    for (std::size_t i = 0; i < 3; ++i) triangle[i] = T_base_world * corners[i].cast<double>();
    const auto slice = SliceOf(triangle, shape_.bottom_m, shape_.top_m);
    least = std::min(least, Distance(footprint, slice));
  });
  return least;
}

double CollisionChecker::PersonGap(const Pose& T_base_world, double time_s, double limit_m) const {
  const double reach =
      limit_m + shape_.front_m + shape_.back_m + shape_.half_width_m + shape_.top_m;
  double least = limit_m;
  for (const PersonPath& path : people_) {
    const Pedestrian person = PedestrianAt(path, time_s);
    const Vector3d center = T_base_world * Vector3d(person.center.cast<double>());
    if (center.norm() > reach + static_cast<double>(kPedestrianRadius)) continue;
    for (const Capsule& part : person.parts) {
      least = std::min(least, GapTo(part, T_base_world, shape_));
    }
  }
  return least;
}

}  // namespace hv::sim
