#include <cmath>

#include "building.h"
#include "furniture.h"
#include "worlds.h"

namespace hv::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// A ladder of narrow corridors: two along x joined by four rungs, and dead ends to the outside.
// Doors, lamps and pipes repeat every module, so places look alike.
constexpr double kHalfWidth = 0.95;
constexpr double kLength = 60.0;
constexpr double kGap = 16.0;  ///< between the axes of the two long corridors
constexpr double kRung = 20.0;
constexpr double kModule = 3.0;
constexpr double kHeight = 2.5;
constexpr double kWallDepth = 0.3;
constexpr double kDeadEnd = 6.0;

std::vector<Vector3d> Route() {
  return {{0.0, 0.0, 0.0},  {20.0, 0.0, 0.0}, {20.0, 16.0, 0.0}, {40.0, 16.0, 0.0},
          {40.0, 0.0, 0.0}, {60.0, 0.0, 0.0}, {60.0, 16.0, 0.0}, {0.0, 16.0, 0.0}};
}

/// A face of a corridor from `from` to `to`, corridor to its right, with a door niche a module and
/// `gaps` where dead ends branch off.
void AddFace(MeshBuilder& mesh, const Vector2d& from, const Vector2d& to,
             const std::vector<double>& gaps) {
  const Vector2d along = (to - from).normalized();
  const Vector2d inward(-along.y(), along.x());
  const double length = (to - from).norm();
  Wall wall;
  wall.from = from + 0.5 * kWallDepth * inward;
  wall.to = to + 0.5 * kWallDepth * inward;
  wall.height = kHeight;
  wall.thickness = kWallDepth;
  std::size_t gap = 0;
  for (double center = 0.5 * kModule; center + 1.0 < length; center += kModule) {
    const bool open = gap < gaps.size() && std::abs(center - gaps[gap]) < 0.5 * kModule;
    const double half = open ? kHalfWidth : 0.48;
    const double middle = open ? gaps[gap++] : center;
    wall.openings.push_back({middle - half, middle + half, 0.0, open ? kHeight : 2.05});
    if (open) continue;
    const Vector2d hinge = from + (middle - 0.43) * along + 0.2 * inward;
    AddDoorLeaf(mesh, {hinge.x(), hinge.y(), 0.0}, std::atan2(along.y(), along.x()), 0.86);
  }
  AddWall(mesh, wall);
}

/// The walls around one block of rooms; corridors run on all four sides.
void AddBlock(MeshBuilder& mesh, const Vector2d& low, const Vector2d& high) {
  AddFace(mesh, low, {high.x(), low.y()}, {});
  AddFace(mesh, {high.x(), low.y()}, high, {});
  AddFace(mesh, high, {low.x(), high.y()}, {});
  AddFace(mesh, {low.x(), high.y()}, low, {});
}

void AddDeadEnd(MeshBuilder& mesh, double x, double y, double outward) {
  const double from = y + outward * (kHalfWidth + kWallDepth);
  const double to = from + outward * kDeadEnd;
  for (const double side : {-1.0, 1.0}) {
    const double edge = x + side * (kHalfWidth + 0.1);
    AddWall(mesh, {{edge, from}, {edge, to}, {}, 0.0, kHeight, 0.2});
  }
  AddWall(mesh, {{x - kHalfWidth, to}, {x + kHalfWidth, to}, {}, 0.0, kHeight, 0.2});
  mesh.AddCylinder({x + 0.5, to - outward * 0.4, 0.0}, {x + 0.5, to - outward * 0.4, 0.9}, 0.25);
}

void AddWalls(MeshBuilder& mesh) {
  const double far = kLength + kHalfWidth;
  const double top = kGap + kHalfWidth;
  const std::vector<double> south = {10.0, 30.0, 50.0};
  std::vector<double> gaps_south;
  std::vector<double> gaps_north;
  for (const double x : south) {
    gaps_south.push_back(far - x);
    gaps_north.push_back(x + kHalfWidth);
    AddDeadEnd(mesh, x, 0.0, -1.0);
    AddDeadEnd(mesh, x, kGap, 1.0);
  }
  AddFace(mesh, {far, -kHalfWidth}, {-kHalfWidth, -kHalfWidth}, gaps_south);
  AddFace(mesh, {-kHalfWidth, top}, {far, top}, gaps_north);
  AddFace(mesh, {-kHalfWidth, -kHalfWidth}, {-kHalfWidth, top}, {});
  AddFace(mesh, {far, top}, {far, -kHalfWidth}, {});
  for (double x = 0.0; x + kRung <= kLength; x += kRung) {
    AddBlock(mesh, {x + kHalfWidth, kHalfWidth}, {x + kRung - kHalfWidth, kGap - kHalfWidth});
  }
}

void AddFloorAndCeiling(MeshBuilder& mesh) {
  const Vector2d low(-1.5, -kDeadEnd - 1.5);
  const Vector2d high(kLength + 1.5, kGap + kDeadEnd + 1.5);
  mesh.SetReflectivity(0.3);
  AddFloor(mesh, {low, high, 0.0});
  mesh.SetReflectivity(0.8);
  AddFloor(mesh, {low, high, kHeight});
}

/// Lamps, pipes and beams, the same in every module.
void AddOverhead(Site& site) {
  MeshBuilder& mesh = site.mesh;
  mesh.SetReflectivity(0.7);
  for (const double y : {0.0, kGap}) {
    for (double x = 0.0; x <= kLength; x += kModule) {
      mesh.AddBox(Upright({x, y, kHeight - 0.06}), Vector3d(0.15, 1.2, 0.08));
      mesh.AddBox(Upright({x + 1.5, y, kHeight - 0.08}), Vector3d(0.2, 2.0 * kHalfWidth, 0.16));
    }
    AddServices(mesh, {-0.9, y + 0.55, 2.25}, {kLength + 0.9, y + 0.55, 2.25}, site.random);
  }
  for (double x = 0.0; x <= kLength; x += kRung) {
    for (double y = 2.0; y < kGap - 1.0; y += kModule) {
      mesh.AddBox(Upright({x, y, kHeight - 0.06}), Vector3d(1.2, 0.15, 0.08));
    }
    AddServices(mesh, {x + 0.55, 1.0, 2.3}, {x + 0.55, kGap - 1.0, 2.3}, site.random);
  }
}

void AddShallowBox(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(random.Uniform(0.3, 0.8));
  mesh.AddBox(at * Upright({0.0, 0.0, random.Uniform(0.4, 1.5)}, 0.0), Vector3d(0.12, 0.15, 0.3));
}

/// Small things on the walls and, rarely, on the floor: all that tells the places apart.
void AddDetails(Site& site) {
  const std::vector<Prop> props = {{AddExtinguisher, 0.09}, {AddShallowBox, 0.1}, {AddBin, 0.16}};
  for (const double y : {-0.85, 0.85, kGap - 0.85, kGap + 0.85}) {
    for (double x = 3.0; x < kLength; x += 2.0 * kModule) {
      const Prop& prop = props[site.random.Chance(0.75) ? 0 : 1 + site.random.Bits() % 2];
      site.Place(prop, {x - 0.4, y, 0.0}, 0.0);
    }
  }
  for (double x = 0.0; x <= kLength; x += kRung) {
    for (const double side : {-0.85, 0.85}) {
      site.Place(props[site.random.Bits() % 3], {x + side, site.random.Uniform(3.0, 13.0), 0.0},
                 0.0);
    }
  }
}

}  // namespace

World MakeCorridor(std::uint32_t seed) {
  World world;
  world.name = "corridor";
  world.route = Route();
  Site site(world.route, world.closed, seed);
  AddFloorAndCeiling(site.mesh);
  site.mesh.SetReflectivity(0.7);
  AddWalls(site.mesh);
  AddOverhead(site);
  AddDetails(site);
  site.mesh.Undulate(0.004, 1.1, seed);
  world.mesh = site.mesh.mesh();
  world.people = {
      {{{5.0, -0.45, 0.0}, {55.0, -0.45, 0.0}, {55.0, 0.45, 0.0}, {5.0, 0.45, 0.0}}, 1.1, 10.0},
      {{{25.0, 15.55, 0.0}, {58.0, 15.55, 0.0}, {58.0, 16.45, 0.0}, {25.0, 16.45, 0.0}}, 1.3, 0.0}};
  return world;
}

}  // namespace hv::sim
