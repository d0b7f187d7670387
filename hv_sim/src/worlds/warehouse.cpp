#include <cmath>

#include "building.h"
#include "furniture.h"
#include "site_props.h"
#include "worlds.h"

namespace hv::sim {
namespace {

using Eigen::Vector3d;

// A hall with double racks along x, aisles between them and open floor at both ends.
constexpr double kLength = 54.0;
constexpr double kDepth = 32.0;
constexpr double kHeight = 8.0;
constexpr double kRackFrom = 8.0;
constexpr double kRackTo = 46.0;
constexpr double kRackDepth = 1.1;
constexpr double kBay = 2.7;
constexpr double kLevel = 1.7;
constexpr int kLevels = 3;

std::vector<double> RackAxes() { return {6.0, 11.0, 16.0, 21.0, 26.0}; }

std::vector<Vector3d> Route() {
  return {{5.0, 3.5, 0.0},  {49.0, 3.5, 0.0},  {49.0, 8.5, 0.0},  {5.0, 8.5, 0.0},
          {5.0, 13.5, 0.0}, {49.0, 13.5, 0.0}, {49.0, 23.5, 0.0}, {5.0, 23.5, 0.0},
          {5.0, 28.5, 0.0}, {49.0, 28.5, 0.0}, {49.0, 18.5, 0.0}, {5.0, 18.5, 0.0}};
}

/// A load on a pallet: cartons, a wrapped block or barrels, never quite straight.
void AddLoad(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(0.4);
  mesh.AddBox(at, Vector3d(-0.55, -0.4, 0.0), Vector3d(0.55, 0.4, 0.13));
  const double kind = random.Uniform();
  if (kind < 0.25) {
    for (const double x : {-0.28, 0.28}) AddBarrel(mesh, at * Upright({x, 0.0, 0.13}), random);
    return;
  }
  mesh.SetReflectivity(random.Uniform(0.3, 0.8));
  if (kind < 0.5) {
    const double height = random.Uniform(0.5, 1.2);
    const Pose block = at * Upright({0.0, 0.0, 0.13 + 0.5 * height}, random.Uniform(-0.05, 0.05));
    mesh.AddBox(block, Vector3d(1.0, 0.75, height));
    return;
  }
  for (int layer = 0; layer < 3; ++layer) {
    for (const double x : {-0.35, 0.0, 0.35}) {
      if (layer > 0 && random.Chance(0.3)) continue;
      const Vector3d size(0.33, random.Uniform(0.5, 0.75), 0.34);
      mesh.SetReflectivity(random.Uniform(0.4, 0.7));
      mesh.AddBox(at * Upright({x, random.Uniform(-0.06, 0.06), 0.3 + 0.35 * layer},
                               random.Uniform(-0.08, 0.08)),
                  size);
    }
  }
}

/// Uprights, braces and beams of one rack whose middle line is at `y`.
void AddRackFrame(MeshBuilder& mesh, double y) {
  mesh.SetReflectivity(0.45);
  const double low = y - 0.5 * kRackDepth;
  const double high = y + 0.5 * kRackDepth;
  const double top = kLevels * kLevel + 0.4;
  for (double x = kRackFrom; x <= kRackTo; x += kBay) {
    for (const double side : {low, high}) {
      mesh.AddBox(Pose::Identity(), Vector3d(x - 0.05, side - 0.04, 0.0),
                  Vector3d(x + 0.05, side + 0.04, top));
    }
    for (double z = 0.3; z + 0.8 < top; z += 0.8) {
      mesh.AddCylinder({x, low, z}, {x, high, z + 0.8}, 0.02, 5);
    }
  }
  for (int level = 1; level <= kLevels; ++level) {
    const double z = level * kLevel;
    for (const double side : {low, high}) {
      mesh.AddBox(Pose::Identity(), Vector3d(kRackFrom, side - 0.03, z - 0.12),
                  Vector3d(kRackTo, side + 0.03, z));
    }
  }
}

void AddRack(Site& site, double y) {
  AddRackFrame(site.mesh, y);
  for (int level = 0; level <= kLevels; ++level) {
    for (double x = kRackFrom + 0.7; x + 0.6 < kRackTo; x += 0.5 * kBay) {
      if (site.random.Chance(0.22)) continue;
      const double yaw = site.random.Uniform(-0.06, 0.06) + (site.random.Chance(0.5) ? M_PI : 0.0);
      AddLoad(site.mesh, Upright({x, y + site.random.Uniform(-0.08, 0.08), level * kLevel}, yaw),
              site.random);
    }
  }
  for (double x = kRackFrom; x <= kRackTo; x += 0.8) site.Reserve({x, y, 0.0}, 0.7);
}

/// Outer walls with loading gates in the west, and columns inside them.
void AddShell(MeshBuilder& mesh) {
  mesh.SetReflectivity(0.3);
  AddFloor(mesh, {{0.0, 0.0}, {kLength, kDepth}, 0.0});
  mesh.SetReflectivity(0.6);
  const std::vector<Opening> gates = {
      {4.0, 7.0, 0.0, 3.4}, {12.0, 15.0, 0.0, 3.4}, {20.0, 23.0, 0.0, 3.4}};
  AddWall(
      mesh,
      {{0.0, 0.0}, {kLength, 0.0}, Windows(kLength, 2.0, 5.0, 2.5, 5.0, 6.5), 0.0, kHeight, 0.3});
  AddWall(mesh, {{kLength, 0.0}, {kLength, kDepth}, {{6.0, 7.2, 0.0, 2.1}}, 0.0, kHeight, 0.3});
  AddWall(mesh, {{kLength, kDepth},
                 {0.0, kDepth},
                 Windows(kLength, 2.0, 5.0, 2.5, 5.0, 6.5),
                 0.0,
                 kHeight,
                 0.3});
  AddWall(mesh, {{0.0, kDepth}, {0.0, 0.0}, gates, 0.0, kHeight, 0.3});
  for (double x = 3.0; x < kLength; x += 6.0) {
    for (const double y : {0.3, kDepth - 0.3}) {
      mesh.AddBox(Upright({x, y, 0.5 * kHeight}), Vector3d(0.3, 0.35, kHeight));
    }
  }
}

/// The ground outside, as far below the floor of the hall as the bed of a lorry is high.
void AddYard(MeshBuilder& mesh) {
  constexpr double kFloorAbove = 1.2;
  constexpr double kWidth = 20.0;
  mesh.SetReflectivity(0.2);
  AddFloor(mesh, {{-kWidth, -kWidth}, {kLength + kWidth, kDepth + kWidth}, -kFloorAbove});
  mesh.SetReflectivity(0.4);
  mesh.AddBox(Upright({0.5 * kLength, 0.5 * kDepth, -0.5 * kFloorAbove - 0.01}),
              Vector3d(kLength, kDepth, kFloorAbove));
}

/// Lattice girders, lamps and a duct under a ridged roof.
void AddRoof(MeshBuilder& mesh) {
  mesh.SetReflectivity(0.5);
  for (const double y : {0.0, 0.5 * kDepth}) {
    const double rise = y > 0.0 ? -1.2 : 1.2;
    mesh.AddQuad({0.0, y, kHeight + (y > 0.0 ? 1.2 : 0.0)}, {kLength, 0.0, 0.0},
                 {0.0, 0.5 * kDepth, rise}, 1.0);
  }
  for (double x = 3.0; x < kLength; x += 6.0) {
    mesh.AddCylinder({x, 0.0, kHeight - 0.9}, {x, kDepth, kHeight - 0.9}, 0.07, 8);
    mesh.AddCylinder({x, 0.0, kHeight}, {x, kDepth, kHeight}, 0.07, 8);
    for (double y = 0.0; y + 1.0 <= kDepth; y += 1.0) {
      const bool up = static_cast<int>(y) % 2 == 0;
      mesh.AddCylinder({x, y, up ? kHeight - 0.9 : kHeight},
                       {x, y + 1.0, up ? kHeight : kHeight - 0.9}, 0.03, 5);
    }
  }
  mesh.AddCylinder({2.0, 1.6, 6.6}, {kLength - 2.0, 1.6, 6.6}, 0.4, 14);
}

void AddForklift(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(0.5);
  mesh.AddBox(at, Vector3d(-1.0, -0.5, 0.25), Vector3d(0.5, 0.5, 1.0));
  mesh.AddBox(at, Vector3d(-1.0, -0.5, 1.0), Vector3d(-0.5, 0.5, 1.3));
  mesh.AddBox(at, Vector3d(-0.8, -0.5, 2.05), Vector3d(0.4, 0.5, 2.1));
  for (const double x : {-0.7, 0.35}) {
    for (const double y : {-0.45, 0.45}) {
      mesh.AddCylinder(at * Vector3d(x, y, 1.0), at * Vector3d(0.8 * x, y, 2.05), 0.03, 6);
      mesh.AddCylinder(at * Vector3d(x, 0.9 * y, 0.25), at * Vector3d(x, 1.2 * y, 0.25), 0.25, 14);
    }
  }
  const double fork = random.Uniform(0.1, 1.0);
  for (const double y : {-0.3, 0.3}) {
    mesh.AddBox(at, Vector3d(0.5, y - 0.06, 0.1), Vector3d(0.62, y + 0.06, 2.3));
    mesh.AddBox(at, Vector3d(0.6, y - 0.05, fork), Vector3d(1.5, y + 0.05, fork + 0.05));
  }
}

void AddPalletLoad(MeshBuilder& mesh, const Pose& at, Random& random) { AddLoad(mesh, at, random); }

void AddOpenFloor(Site& site) {
  const std::vector<Prop> props = {
      {AddPalletLoad, 0.72}, {AddPalletLoad, 0.72},  {AddForklift, 1.7},    {AddBarrel, 0.35},
      {AddCableDrum, 0.7},   {AddCartonStack, 0.35}, {AddTrafficCone, 0.3}, {AddPlankPile, 1.1}};
  site.Scatter(props, {{0.8, 0.8}, {7.5, 31.2}, 0.0}, 90);
  site.Scatter(props, {{46.8, 0.8}, {53.2, 31.2}, 0.0}, 90);
  site.Scatter(props, {{8.0, 0.8}, {46.0, 2.2}, 0.0}, 60);
  site.Scatter(props, {{8.0, 30.0}, {46.0, 31.2}, 0.0}, 60);
  for (double x = kRackFrom; x <= kRackTo; x += kRackTo - kRackFrom) {
    for (const double y : RackAxes()) {
      site.mesh.SetReflectivity(0.8);
      site.mesh.AddCylinder({x, y - 0.75, 0.0}, {x, y - 0.75, 0.6}, 0.07);
    }
  }
}

}  // namespace

World MakeWarehouse(std::uint32_t seed) {
  World world;
  world.name = "warehouse";
  world.route = Route();
  Site site(world.route, world.closed, seed);
  AddYard(site.mesh);
  AddShell(site.mesh);
  for (const double y : RackAxes()) AddRack(site, y);
  AddRoof(site.mesh);
  AddOpenFloor(site);
  site.mesh.Undulate(0.005, 1.7, seed);
  world.mesh = site.mesh.mesh();
  world.people = {
      {{{9.0, 7.6, 0.0}, {45.0, 7.6, 0.0}, {45.0, 9.4, 0.0}, {9.0, 9.4, 0.0}}, 1.3, 0.0},
      {{{9.0, 17.7, 0.0}, {45.0, 17.7, 0.0}, {45.0, 19.3, 0.0}, {9.0, 19.3, 0.0}}, 1.1, 30.0},
      {{{48.2, 5.0, 0.0}, {49.9, 5.0, 0.0}, {49.9, 27.0, 0.0}, {48.2, 27.0, 0.0}}, 1.2, 8.0}};
  return world;
}

}  // namespace hv::sim
