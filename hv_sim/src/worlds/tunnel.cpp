#include <algorithm>
#include <cmath>
#include <functional>

#include "building.h"
#include "furniture.h"
#include "site_props.h"
#include "worlds.h"

namespace hv::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kHalfWidth = 2.6;
constexpr double kSide = 1.8;   ///< height where the arch starts
constexpr double kCrown = 4.4;  ///< inner height

/// Point of the cross section at `share` of its wall, from the right foot over the crown to the
/// left foot; across to the left, and up.
Vector2d Profile(double share) {
  const double straight = 0.25;
  if (share < straight) return {-kHalfWidth, kSide * share / straight};
  if (share > 1.0 - straight) return {kHalfWidth, kSide * (1.0 - share) / straight};
  const double angle = M_PI * (share - straight) / (1.0 - 2.0 * straight);
  return {-kHalfWidth * std::cos(angle), kSide + (kCrown - kSide) * std::sin(angle)};
}

/// Middle line of a tunnel, by arc length.
struct Axis {
  std::vector<Vector3d> points;
  double step = 1.0;

  double length() const { return step * static_cast<double>(points.size() - 1); }

  Vector3d At(double s) const {
    const double place = std::clamp(s / step, 0.0, static_cast<double>(points.size()) - 1.0001);
    const auto i = static_cast<std::size_t>(place);
    return points[i] + (place - static_cast<double>(i)) * (points[i + 1] - points[i]);
  }

  /// Frame on the floor: x ahead, y to the left, z up.
  Pose FrameAt(double s) const {
    const Vector3d ahead = At(s + 0.3) - At(s - 0.3);
    return Upright(At(s), std::atan2(ahead.y(), ahead.x()));
  }
};

/// Two bends to opposite sides with a straight between them, and a dip.
Axis BentAxis() {
  Axis axis;
  Vector3d at = Vector3d::Zero();
  double heading = 0.0;
  for (double s = 0.0; s <= 220.0; s += axis.step) {
    axis.points.push_back(at);
    if (s > 30.0 && s < 85.0) heading += axis.step / 38.0;
    if (s > 115.0 && s < 180.0) heading -= axis.step / 30.0;
    const double slope = 0.03 * std::sin(2.0 * M_PI * s / 220.0);
    at += axis.step * Vector3d(std::cos(heading), std::sin(heading), -slope);
  }
  return axis;
}

Axis StraightAxis() {
  Axis axis;
  for (double s = 0.0; s <= 230.0; s += axis.step) axis.points.emplace_back(s, 0.0, 0.0);
  return axis;
}

/// Lining and road between two stations; `roughness` [m] moves the lining along its normal.
void AddLining(MeshBuilder& mesh, const Axis& axis, double from, double to, double roughness,
               std::uint32_t seed) {
  const int rings = static_cast<int>(std::ceil((to - from) / (roughness > 0.0 ? 0.5 : 1.0)));
  const auto station = [&](double s) { return axis.FrameAt(from + s * (to - from)); };
  mesh.SetReflectivity(0.45);
  mesh.AddPatch(rings, 24, [&](double s, double t) -> Vector3d {
    const Vector2d wall = Profile(t);
    const Vector3d smooth = station(s) * Vector3d(0.0, wall.x(), wall.y());
    if (roughness <= 0.0) return smooth;
    const double bulge =
        roughness * (SmoothNoise(smooth / 1.6, seed) + 0.4 * SmoothNoise(smooth / 0.5, seed + 7));
    const Vector3d inward(0.0, -wall.x() / kHalfWidth, -wall.y() / kCrown);
    return smooth + station(s).linear() * Vector3d(bulge * inward.normalized());
  });
  mesh.SetReflectivity(0.25);
  mesh.AddPatch(rings, 8, [&](double s, double t) -> Vector3d {
    return station(s) * Vector3d(0.0, (2.0 * t - 1.0) * (kHalfWidth + 0.4), 0.0);
  });
}

/// Something long that follows the axis at a fixed place of the cross section.
void AddLine(MeshBuilder& mesh, const Axis& axis, double from, double to, const Vector2d& place,
             double radius) {
  std::vector<Vector3d> points;
  for (double s = from; s <= to; s += 2.0) {
    points.push_back(axis.FrameAt(s) * Vector3d(0.0, place.x(), place.y()));
  }
  mesh.AddTube(points, radius);
}

void AddNiche(MeshBuilder& mesh, const Pose& at, double side) {
  mesh.SetReflectivity(0.5);
  const auto block = [&](double x0, double x1, double z0, double z1) {
    const double wall = side * (kHalfWidth - 0.02);
    const double inner = side * (kHalfWidth - 0.3);
    mesh.AddBox(at, Vector3d(x0, std::min(wall, inner), z0),
                Vector3d(x1, std::max(wall, inner), z1));
  };
  block(-0.9, -0.7, 0.0, 2.2);
  block(0.7, 0.9, 0.0, 2.2);
  block(-0.9, 0.9, 2.2, 2.4);
  block(-0.4, 0.4, 0.6, 1.4);
}

/// Lamps, brackets, niches, signs and a sagging cable between two stations.
void AddFittings(Site& site, const Axis& axis, double from, double to) {
  MeshBuilder& mesh = site.mesh;
  mesh.SetReflectivity(0.6);
  AddLine(mesh, axis, from, to, {2.35, 2.3}, 0.09);
  AddLine(mesh, axis, from, to, {2.4, 2.0}, 0.05);
  AddLine(mesh, axis, from, to, {-1.3, 3.75}, 0.25);
  for (double s = from + 3.0; s < to - 3.0; s += site.random.Uniform(5.0, 9.0)) {
    const Pose at = axis.FrameAt(s);
    const double side = site.random.Chance(0.5) ? 1.0 : -1.0;
    mesh.SetReflectivity(0.8);
    mesh.AddBox(at * Upright({0.0, 0.6, kCrown - 0.25}), Vector3d(1.0, 0.2, 0.12));
    if (site.random.Chance(0.6)) AddNiche(mesh, at, side);
    if (site.random.Chance(0.5)) {
      mesh.AddBox(at * Upright({1.5, -side * 2.5, 1.7}), Vector3d(0.5, 0.12, 0.4));
    }
    const Vector3d hook = at * Vector3d(0.0, -2.35, 2.4);
    mesh.AddCable(hook, axis.FrameAt(s + 4.5) * Vector3d(0.0, -2.35, 2.4),
                  site.random.Uniform(0.1, 0.4), 0.025);
  }
}

void AddClutter(Site& site, const Axis& axis, double from, double to) {
  const std::vector<Prop> props = {{AddMound, 0.85},       {AddBarrel, 0.35},
                                   {AddTrafficCone, 0.3},  {AddPipeStack, 1.2},
                                   {AddCartonStack, 0.32}, {AddCableDrum, 0.7}};
  for (double s = from + 1.0; s < to - 1.0; s += site.random.Uniform(1.5, 5.0)) {
    const double side = site.random.Chance(0.5) ? 1.0 : -1.0;
    const Pose at = axis.FrameAt(s);
    const double yaw = std::atan2(at.linear()(1, 0), at.linear()(0, 0));
    const Prop& prop = props[site.random.Bits() % props.size()];
    site.Place(prop, at * Vector3d(0.0, side * site.random.Uniform(1.3, 2.1), 0.0), yaw);
  }
}

/// A wall with a gate across the end of the tunnel.
void AddPortal(MeshBuilder& mesh, const Axis& axis, double s) {
  mesh.SetReflectivity(0.6);
  const Pose at = axis.FrameAt(s);
  const Vector3d left = at * Vector3d(0.0, kHalfWidth, 0.0);
  const Vector3d right = at * Vector3d(0.0, -kHalfWidth, 0.0);
  AddWall(mesh, {left.head<2>(),
                 right.head<2>(),
                 {{0.7, 2.0, 0.0, 2.1}, {3.2, 4.4, 1.0, 2.0}},
                 left.z(),
                 kCrown,
                 0.3});
}

/// Level ground before a portal, in a cutting between retaining walls. `ahead` is 1 where the
/// tunnel ends and -1 where it begins.
void AddForecourt(MeshBuilder& mesh, const Axis& axis, double s, double ahead) {
  constexpr double kLength = 12.0;
  constexpr double kHalf = 6.0;  // of its width
  constexpr double kHeight = 5.0;
  constexpr double kOverlap = 0.3;  // with the road of the tunnel, so that no crack is left
  const Pose at = axis.FrameAt(s);
  mesh.SetReflectivity(0.25);
  mesh.AddPatch(12, 12, [&](double u, double v) -> Vector3d {
    return at *
           Vector3d(ahead * (kLength * u - kOverlap * (1.0 - u)), kHalf * (2.0 * v - 1.0), 0.0);
  });
  mesh.SetReflectivity(0.5);
  const auto wall = [&](double x0, double x1, double y0, double y1) {
    mesh.AddBox(at, Vector3d(std::min(ahead * x0, ahead * x1), y0, 0.0),
                Vector3d(std::max(ahead * x0, ahead * x1), y1, kHeight));
  };
  wall(0.0, 0.3, -kHalf, -kHalfWidth);
  wall(0.0, 0.3, kHalfWidth, kHalf);
  wall(0.0, kLength, -kHalf - 0.3, -kHalf);
  wall(0.0, kLength, kHalf, kHalf + 0.3);
  wall(kLength, kLength + 0.3, -kHalf, kHalf);
}

std::vector<Vector3d> RouteAlong(const Axis& axis, double from, double to) {
  std::vector<Vector3d> route;
  for (double s = from; s <= to; s += 2.0) {
    route.emplace_back(axis.FrameAt(s) * Vector3d(0.0, 0.25 * std::sin(0.15 * s), 0.0));
  }
  return route;
}

PersonPath Walker(const Axis& axis, double from, double to, double phase) {
  PersonPath path;
  for (double s = from; s <= to; s += 4.0)
    path.waypoints.emplace_back(axis.FrameAt(s) * Vector3d(0.0, 0.95, 0.0));
  for (double s = to; s >= from; s -= 4.0)
    path.waypoints.emplace_back(axis.FrameAt(s) * Vector3d(0.0, -0.95, 0.0));
  path.phase = phase;
  return path;
}

}  // namespace

World MakeTunnel(std::uint32_t seed) {
  const Axis axis = BentAxis();
  World world;
  world.name = "tunnel";
  world.closed = false;
  world.route = RouteAlong(axis, 6.0, axis.length() - 6.0);
  Site site(world.route, world.closed, seed);
  AddLining(site.mesh, axis, 0.0, axis.length(), 0.07, seed);
  AddFittings(site, axis, 0.0, axis.length());
  AddClutter(site, axis, 3.0, axis.length() - 3.0);
  AddPortal(site.mesh, axis, 0.5);
  AddPortal(site.mesh, axis, axis.length() - 0.5);
  AddForecourt(site.mesh, axis, 0.0, -1.0);
  AddForecourt(site.mesh, axis, axis.length(), 1.0);
  site.mesh.Undulate(0.006, 0.9, seed);
  world.mesh = site.mesh.mesh();
  world.people = {Walker(axis, 20.0, 80.0, 0.0), Walker(axis, 120.0, 200.0, 40.0)};
  return world;
}

World MakeStraightTunnel(std::uint32_t seed) {
  constexpr double kPortal = 30.0;  // detailed length at both ends
  const Axis axis = StraightAxis();
  const double far = axis.length() - kPortal;
  World world;
  world.name = "tunnel_straight";
  world.closed = false;
  world.route = {{6.0, 0.0, 0.0}, {axis.length() - 6.0, 0.0, 0.0}};
  Site site(world.route, world.closed, seed);
  AddLining(site.mesh, axis, 0.0, kPortal, 0.04, seed);
  AddLining(site.mesh, axis, far, axis.length(), 0.04, seed);
  for (const double from : {0.0, far}) {
    AddFittings(site, axis, from, from + kPortal);
    AddClutter(site, axis, from + 3.0, from + kPortal - 1.0);
  }
  AddPortal(site.mesh, axis, 0.5);
  AddPortal(site.mesh, axis, axis.length() - 0.5);
  site.mesh.Undulate(0.005, 0.9, seed);
  // Black with soot, so that a scanner loses the ends and sees nothing but the smooth lining, which
  // is added last and overlaps the ends so that no crack is left.
  site.mesh.LimitReflectivity(0.03);
  constexpr double kOverlap = 0.05;
  AddLining(site.mesh, axis, kPortal - kOverlap, far + kOverlap, 0.0, seed);
  world.mesh = site.mesh.mesh();
  return world;
}

}  // namespace hv::sim
