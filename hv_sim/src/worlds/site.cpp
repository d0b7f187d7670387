#include "site.h"

#include <cmath>

#include "hv_sim/route.h"

namespace hv::sim {
namespace {

using Eigen::Vector3d;

constexpr double kRouteMargin = 0.75;  ///< promised 0.6 m, plus undulation and overhang
constexpr double kStoreyHeight = 2.0;  ///< heights apart by more do not meet

bool Touches(const Vector3d& a, const Vector3d& b, double distance) {
  return std::abs(a.z() - b.z()) < kStoreyHeight && (a - b).head<2>().norm() < distance;
}

}  // namespace

Site::Site(const std::vector<Vector3d>& route, bool closed, std::uint32_t seed)
    : random({seed}), route_(SampleRoute(route, closed, 0.0, 0.2)) {
  const std::vector<Vector3d> rounded = SampleRoute(route, closed, 1.0, 0.2);
  route_.insert(route_.end(), rounded.begin(), rounded.end());
}

bool Site::IsFree(const Disc& disc) const {
  for (const Vector3d& point : route_) {
    if (Touches(point, disc.at, disc.radius + kRouteMargin)) return false;
  }
  for (const Disc& other : taken_) {
    if (Touches(other.at, disc.at, disc.radius + other.radius)) return false;
  }
  return true;
}

void Site::Reserve(const Vector3d& at, double radius) { taken_.push_back({at, radius}); }

bool Site::Place(const Prop& prop, const Vector3d& at, double yaw) {
  if (!IsFree({at, prop.radius})) return false;
  Reserve(at, prop.radius);
  prop.add(mesh, Upright(at, yaw), random);
  return true;
}

void Site::Scatter(const std::vector<Prop>& props, const Area& area, int count) {
  for (int i = 0; i < count; ++i) {
    const Prop& prop = props[random.Bits() % props.size()];
    const Vector3d at(random.Uniform(area.low.x(), area.high.x()),
                      random.Uniform(area.low.y(), area.high.y()), area.z);
    Place(prop, at, random.Uniform(-M_PI, M_PI));
  }
}

void Site::LineUp(const std::vector<Prop>& props, const Vector3d& from, const Vector3d& to) {
  const Vector3d along = (to - from).normalized();
  const double yaw = std::atan2(along.x(), -along.y());
  const double length = (to - from).norm();
  double done = 0.0;
  while (done < length) {
    const Prop& prop = props[random.Bits() % props.size()];
    done += prop.radius;
    if (done + prop.radius > length) break;
    const Vector3d at = from + done * along;
    if (!random.Chance(0.1)) Place(prop, at, yaw + random.Uniform(-0.05, 0.05));
    done += prop.radius + random.Uniform(0.0, 0.5);
  }
}

}  // namespace hv::sim
