#include "hv_sim/pedestrian.h"

#include <algorithm>
#include <cmath>

namespace hv::sim {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

struct Walk {
  Vector3d feet = Vector3d::Zero();
  Vector3d heading = Vector3d::UnitX();
  double walked = 0.0;  ///< [m]
};

Walk WalkAt(const PersonPath& path, double time_s) {
  const std::size_t count = path.waypoints.size();
  double perimeter = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    perimeter += (path.waypoints[(i + 1) % count] - path.waypoints[i]).norm();
  }
  Walk walk;
  walk.walked = path.phase + path.speed * time_s;
  double left = walk.walked - perimeter * std::floor(walk.walked / perimeter);
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d& from = path.waypoints[i];
    const Vector3d along = path.waypoints[(i + 1) % count] - from;
    const double length = along.norm();
    if (left <= length || i + 1 == count) {
      walk.feet = from + along * (left / length);
      walk.heading = Vector3d(along.x(), along.y(), 0.0).normalized();
      break;
    }
    left -= length;
  }
  return walk;
}

/// Entry of the ray into a sphere, or infinity.
float SphereRange(const Ray& ray, const Vector3f& center, float radius) {
  const Vector3f to_center = center - ray.origin;
  const float along = to_center.dot(ray.direction);
  const float gap = radius * radius - (to_center.squaredNorm() - along * along);
  if (gap < 0.0F || along < 0.0F) return std::numeric_limits<float>::infinity();
  return along - std::sqrt(gap);
}

/// Entry of the ray into the cylinder between the ends of the capsule, or infinity.
float CylinderRange(const Ray& ray, const Capsule& capsule) {
  constexpr float kMiss = std::numeric_limits<float>::infinity();
  const Vector3f axis = capsule.to - capsule.from;
  const Vector3f offset = ray.origin - capsule.from;
  const float length2 = axis.squaredNorm();
  const float axis_direction = axis.dot(ray.direction);
  const float axis_offset = axis.dot(offset);
  const float a = length2 - axis_direction * axis_direction;
  const float b = length2 * ray.direction.dot(offset) - axis_offset * axis_direction;
  const float c = length2 * (offset.squaredNorm() - capsule.radius * capsule.radius) -
                  axis_offset * axis_offset;
  const float discriminant = b * b - a * c;
  if (discriminant < 0.0F || a <= 0.0F) return kMiss;
  const float range = (-b - std::sqrt(discriminant)) / a;
  const float height = axis_offset + range * axis_direction;
  return height > 0.0F && height < length2 ? range : kMiss;
}

float CapsuleRange(const Ray& ray, const Capsule& capsule) {
  return std::min({CylinderRange(ray, capsule), SphereRange(ray, capsule.from, capsule.radius),
                   SphereRange(ray, capsule.to, capsule.radius)});
}

float CosineAt(const Ray& ray, const Capsule& capsule, float range) {
  const Vector3f point = ray.origin + range * ray.direction;
  const Vector3f axis = capsule.to - capsule.from;
  const float share = axis.dot(point - capsule.from) / axis.squaredNorm();
  const Vector3f nearest = capsule.from + std::clamp(share, 0.0F, 1.0F) * axis;
  return std::abs((point - nearest).normalized().dot(ray.direction));
}

}  // namespace

Vector3d FeetAt(const PersonPath& path, double time_s) { return WalkAt(path, time_s).feet; }

Pedestrian PedestrianAt(const PersonPath& path, double time_s) {
  const Walk walk = WalkAt(path, time_s);
  const Vector3d left(-walk.heading.y(), walk.heading.x(), 0.0);
  const auto at = [&](double forward, double side, double up) -> Vector3f {
    const Vector3d point = walk.feet + forward * walk.heading + side * left;
    return (point + up * Vector3d::UnitZ()).cast<float>();
  };
  constexpr double kStride = 1.4;  // [m] for both legs
  const double swing = std::sin(2.0 * M_PI * walk.walked / kStride);
  const double leg = 0.33 * swing;
  const double arm = 0.25 * swing;
  Pedestrian person;
  person.center = at(0.0, 0.0, 0.9);
  person.parts = {Capsule{at(0.0, 0.0, 1.02), at(0.0, 0.0, 1.35), 0.17F},
                  Capsule{at(0.02, 0.0, 1.58), at(0.02, 0.0, 1.66), 0.10F},
                  Capsule{at(0.0, 0.1, 0.9), at(leg, 0.1, 0.09), 0.075F},
                  Capsule{at(0.0, -0.1, 0.9), at(-leg, -0.1, 0.09), 0.075F},
                  Capsule{at(0.0, 0.23, 1.38), at(-arm, 0.26, 0.85), 0.05F},
                  Capsule{at(0.0, -0.23, 1.38), at(arm, -0.26, 0.85), 0.05F}};
  return person;
}

void Intersect(const Pedestrian& person, const Ray& ray, Hit& hit) {
  const Vector3f to_center = person.center - ray.origin;
  const float along = to_center.dot(ray.direction);
  const float miss2 = (to_center - along * ray.direction).squaredNorm();
  if (miss2 > kPedestrianRadius * kPedestrianRadius || along < -kPedestrianRadius) return;
  // Seen from afar, single precision needs an origin near the body.
  const float skip = std::max(0.0F, along - 2.0F * kPedestrianRadius);
  const Ray near{ray.origin + skip * ray.direction, ray.direction};
  constexpr float kClothes = 0.4F;
  for (const Capsule& part : person.parts) {
    const float range = CapsuleRange(near, part);
    if (range > 0.0F && skip + range < hit.range) {
      hit = {skip + range, CosineAt(near, part, range), kClothes};
    }
  }
}

}  // namespace hv::sim
