#include <algorithm>
#include <cmath>

#include "building.h"
#include "site_props.h"
#include "worlds.h"

namespace hv::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Two storeys of bare concrete on a grid of columns; a ramp along the north side joins them.
constexpr double kLength = 44.0;
constexpr double kDepth = 20.0;
constexpr double kStorey = 3.8;
constexpr double kSlab = 0.25;
constexpr double kRampFrom = 8.0;
constexpr double kRampTo = 36.0;
constexpr double kRampLow = 21.5;
constexpr double kRampHigh = 25.5;
constexpr double kLanding = 28.0;

std::vector<Vector3d> Route() {
  constexpr double kRamp = 23.5;
  return {{7.0, 6.0, 0.0},        {37.0, 6.0, 0.0},          {37.0, 12.0, 0.0},
          {13.0, 12.0, 0.0},      {13.0, 18.0, 0.0},         {5.0, 18.0, 0.0},
          {5.0, kRamp, 0.0},      {kRampFrom, kRamp, 0.0},   {kRampTo, kRamp, kStorey},
          {39.0, kRamp, kStorey}, {39.0, 18.0, kStorey},     {25.0, 18.0, kStorey},
          {25.0, 6.0, kStorey},   {7.0, 6.0, kStorey},       {7.0, 12.0, kStorey},
          {13.0, 12.0, kStorey},  {13.0, 18.0, kStorey},     {39.0, 18.0, kStorey},
          {39.0, kRamp, kStorey}, {kRampTo, kRamp, kStorey}, {kRampFrom, kRamp, 0.0},
          {5.0, kRamp, 0.0},      {7.0, 19.0, 0.0}};
}

/// Level inside the site, uneven outside.
double TerrainHeight(double x, double y, std::uint32_t seed) {
  const double outside = std::max({-1.5 - x, x - kLength - 1.5, -2.5 - y, y - kLanding - 0.5, 0.0});
  const double share = std::min(1.0, outside / 4.0);
  return -0.01 + share * (0.35 * SmoothNoise({x / 4.0, y / 4.0, 0.0}, seed) +
                          0.08 * SmoothNoise({x, y, 0.0}, seed + 1));
}

void AddTerrain(MeshBuilder& mesh, std::uint32_t seed) {
  mesh.SetReflectivity(0.25);
  mesh.AddPatch(120, 100, [seed](double s, double t) -> Vector3d {
    const double x = -18.0 + 80.0 * s;
    const double y = -18.0 + 64.0 * t;
    return {x, y, TerrainHeight(x, y, seed)};
  });
}

void AddSlab(MeshBuilder& mesh, const Vector2d& low, const Vector2d& high, double top) {
  mesh.AddBox(Pose::Identity(), Vector3d(low.x(), low.y(), top - kSlab),
              Vector3d(high.x(), high.y(), top));
}

/// The upper floor around a shaft and a stairwell that are still open.
void AddUpperFloor(MeshBuilder& mesh) {
  mesh.SetReflectivity(0.4);
  AddSlab(mesh, {0.0, 0.0}, {18.0, kDepth}, kStorey);
  AddSlab(mesh, {18.0, 0.0}, {22.0, 8.0}, kStorey);
  AddSlab(mesh, {18.0, 11.0}, {22.0, kDepth}, kStorey);
  AddSlab(mesh, {22.0, 0.0}, {kLength, kDepth}, kStorey);
  AddSlab(mesh, {kRampTo, kDepth}, {kLength, kLanding}, kStorey);
  for (double x = 0.0; x < kLength; x += 6.0) {
    mesh.AddBox(Pose::Identity(), Vector3d(x + 3.85, 0.0, kStorey - 0.55),
                Vector3d(x + 4.15, kDepth, kStorey - kSlab));
  }
}

void AddRamp(MeshBuilder& mesh) {
  const Vector3d along(kRampTo - kRampFrom, 0.0, kStorey);
  const Vector3d across(0.0, kRampHigh - kRampLow, 0.0);
  const Vector3d foot(kRampFrom, kRampLow, 0.0);
  mesh.AddQuad(foot, along, across);
  mesh.AddQuad(foot - kSlab * Vector3d::UnitZ(), along, across);
  for (const double y : {kRampLow, kRampHigh - 0.15}) {
    const Vector3d curb(kRampFrom, y, -kSlab);
    const Vector3d up(0.0, 0.0, kSlab + 0.3);
    const Vector3d thick(0.0, 0.15, 0.0);
    mesh.AddQuad(curb, along, up);
    mesh.AddQuad(curb + thick, along, up);
    mesh.AddQuad(curb + up, along, thick);
  }
  for (double x = 14.0; x < kRampTo; x += 5.0) {
    const double top = kStorey * (x - kRampFrom) / (kRampTo - kRampFrom) - kSlab;
    for (const double y : {kRampLow + 0.3, kRampHigh - 0.3}) {
      mesh.AddCylinder({x, y, -0.05}, {x, y, top}, 0.2);
    }
  }
  const auto edge = [](double y) {
    return std::vector<Vector3d>{{kRampFrom + 1.0, y, 0.3 + kStorey / 28.0},
                                 {kRampTo, y, kStorey + 0.3}};
  };
  AddRailing(mesh, edge(kRampHigh - 0.07));
  AddRailing(mesh, edge(kRampLow + 0.07));
}

/// Columns with bars sticking out of the upper ones.
void AddColumns(Site& site) {
  MeshBuilder& mesh = site.mesh;
  for (double x = 4.0; x < kLength; x += 6.0) {
    for (const double y : {3.0, 9.0, 15.0}) {
      mesh.SetReflectivity(0.45);
      mesh.AddBox(Upright({x, y, 0.5 * kStorey}), Vector3d(0.4, 0.4, kStorey));
      site.Reserve({x, y, 0.0}, 0.3);
      if (site.random.Chance(0.25)) continue;
      const double height = site.random.Uniform(0.6, 3.0);
      mesh.AddBox(Upright({x, y, kStorey + 0.5 * height}), Vector3d(0.4, 0.4, height));
      site.Reserve({x, y, kStorey}, 0.3);
      for (int bar = 0; bar < 8; ++bar) {
        const Vector3d foot(x - 0.15 + 0.3 * (bar % 2), y - 0.15 + 0.1 * (bar / 2),
                            kStorey + height);
        const Vector3d bend(site.random.Uniform(-0.1, 0.1), site.random.Uniform(-0.1, 0.1), 0.8);
        mesh.AddCylinder(foot, foot + bend, 0.012, 5);
      }
    }
  }
}

void AddPartialWalls(Site& site) {
  MeshBuilder& mesh = site.mesh;
  mesh.SetReflectivity(0.35);
  const double ground = kStorey - kSlab;
  AddWall(mesh, {{0.0, 0.2}, {24.0, 0.2}, Windows(24.0, 1.5, 4.0, 2.0), 0.0, ground, 0.24});
  AddWall(mesh, {{0.2, 0.0}, {0.2, 15.0}, Windows(15.0, 2.0, 4.0, 1.5), 0.0, ground, 0.24});
  AddWall(mesh,
          {{43.8, 4.0}, {43.8, kDepth}, Windows(16.0, 1.0, 5.0, 3.0, 1.2), 0.0, ground, 0.24});
  AddWall(mesh, {{28.0, 0.0}, {28.0, 4.2}, {{1.0, 2.0, 0.0, 2.1}}, 0.0, ground, 0.2});
  AddWall(
      mesh,
      {{20.0, 14.5}, {32.0, 14.5}, {{2.0, 3.2, 0.0, 2.1}, {7.0, 9.0, 0.9, 2.2}}, 0.0, ground, 0.2});
  AddWall(mesh, {{16.0, 16.5}, {16.0, kDepth}, {}, 0.0, 1.4, 0.2});
  AddWall(mesh, {{0.0, 0.2}, {16.0, 0.2}, Windows(16.0, 1.5, 4.0, 2.0), kStorey, 2.6, 0.24});
  AddWall(mesh, {{0.2, 0.0}, {0.2, 12.0}, Windows(12.0, 2.0, 4.0, 1.5), kStorey, 1.9, 0.24});
  AddWall(
      mesh,
      {{30.0, 2.0}, {30.0, 14.0}, {{3.0, 4.2, 0.0, 2.1}, {7.0, 8.5, 0.9, 2.0}}, kStorey, 2.4, 0.2});
  AddWall(mesh, {{30.0, 8.0}, {38.0, 8.0}, {{2.0, 3.2, 0.0, 2.1}}, kStorey, 1.3, 0.2});
  mesh.SetReflectivity(0.5);
  AddRailing(mesh, {{16.0, 0.2, kStorey},
                    {kLength - 0.2, 0.2, kStorey},
                    {kLength - 0.2, kLanding - 0.2, kStorey},
                    {kRampTo + 0.5, kLanding - 0.2, kStorey}});
  AddRailing(
      mesh,
      {{0.2, 12.0, kStorey}, {0.2, kDepth - 0.2, kStorey}, {kRampTo - 0.5, kDepth - 0.2, kStorey}});
  AddRailing(mesh, {{17.8, 7.8, kStorey},
                    {22.2, 7.8, kStorey},
                    {22.2, 11.2, kStorey},
                    {17.8, 11.2, kStorey},
                    {17.8, 7.8, kStorey}});
}

/// Keeps clutter out of walls by reserving discs along them.
void ReserveLine(Site& site, const Vector3d& from, const Vector3d& to) {
  const int count = static_cast<int>((to - from).norm() / 0.4) + 1;
  for (int i = 0; i <= count; ++i) site.Reserve(from + (to - from) * i / count, 0.25);
}

void ReserveWalls(Site& site) {
  for (const double z : {0.0, kStorey}) {
    ReserveLine(site, {0.2, 0.2, z}, {kLength - 0.2, 0.2, z});
    ReserveLine(site, {0.2, 0.2, z}, {0.2, kDepth, z});
    ReserveLine(site, {kLength - 0.2, 0.2, z}, {kLength - 0.2, kLanding, z});
  }
  ReserveLine(site, {28.0, 0.0, 0.0}, {28.0, 4.2, 0.0});
  ReserveLine(site, {20.0, 14.5, 0.0}, {32.0, 14.5, 0.0});
  ReserveLine(site, {16.0, 16.5, 0.0}, {16.0, kDepth, 0.0});
  ReserveLine(site, {30.0, 2.0, kStorey}, {30.0, 14.0, kStorey});
  ReserveLine(site, {30.0, 8.0, kStorey}, {38.0, 8.0, kStorey});
  site.Reserve({20.0, 9.5, kStorey}, 3.2);
}

/// A deck of formwork on steel props over a part of the upper floor.
void AddFormwork(Site& site) {
  MeshBuilder& mesh = site.mesh;
  const double deck = kStorey + 3.0;
  mesh.SetReflectivity(0.5);
  mesh.AddBox(Pose::Identity(), Vector3d(0.5, 0.5, deck), Vector3d(15.5, 8.5, deck + 0.03));
  for (double x = 1.0; x < 15.5; x += 1.6) {
    mesh.AddBox(Pose::Identity(), Vector3d(x - 0.04, 0.5, deck - 0.2),
                Vector3d(x + 0.04, 8.5, deck));
    for (const double y : {1.2, 4.0, 8.0}) {
      const Vector3d foot(x + site.random.Uniform(-0.1, 0.1), y, kStorey);
      if (!site.Place({[](MeshBuilder& at_mesh, const Pose& at, Random&) {
                         at_mesh.AddCylinder(at.translation(), at * Vector3d(0.0, 0.0, 2.8), 0.04,
                                             8);
                       },
                       0.1},
                      foot, 0.0)) {
        continue;
      }
    }
  }
}

void AddCables(Site& site) {
  site.mesh.SetReflectivity(0.3);
  for (int i = 0; i < 14; ++i) {
    const Vector3d from(site.random.Uniform(1.0, 43.0), site.random.Uniform(1.0, 19.0), 3.2);
    const Vector3d to =
        from + Vector3d(site.random.Uniform(-6.0, 6.0), site.random.Uniform(-5.0, 5.0), 0.0);
    site.mesh.AddCable(from, to, site.random.Uniform(0.1, 0.45), 0.015);
  }
}

void AddCrane(MeshBuilder& mesh, const Vector3d& foot) {
  mesh.SetReflectivity(0.6);
  const auto corner = [&foot](int i, double z) -> Vector3d {
    return foot + Vector3d(i % 3 == 0 ? -0.8 : 0.8, i < 2 ? -0.8 : 0.8, z);
  };
  for (int i = 0; i < 4; ++i) {
    mesh.AddCylinder(corner(i, 0.0), corner(i, 24.0), 0.08, 6);
    for (double z = 0.0; z < 24.0; z += 2.0) {
      mesh.AddCylinder(corner(i, z), corner((i + 1) % 4, z + 2.0), 0.04, 5);
    }
  }
}

void AddSurroundings(Site& site, std::uint32_t seed) {
  AddScaffold(site.mesh, Upright({0.0, -1.5, 0.0}), 24.0, 3);
  AddScaffold(site.mesh, Upright({45.5, 4.0, 0.0}, 0.5 * M_PI), 16.0, 2);
  AddCrane(site.mesh, {-6.0, 10.0, 0.0});
  const std::vector<Prop> heavy = {{AddBigMound, 2.5},
                                   {AddContainer, 3.4},
                                   {AddMound, 0.9},
                                   {AddPipeStack, 1.2},
                                   {AddCableDrum, 0.7}};
  for (int i = 0; i < 120; ++i) {
    const double x = site.random.Uniform(-15.0, 58.0);
    const double y = site.random.Uniform(-15.0, 42.0);
    const bool inside = x > -4.0 && x < kLength + 4.0 && y > -5.0 && y < kLanding + 2.0;
    if (inside) continue;
    const Prop& prop = heavy[site.random.Bits() % heavy.size()];
    site.Place(prop, {x, y, TerrainHeight(x, y, seed)}, site.random.Uniform(-M_PI, M_PI));
  }
}

void AddClutter(Site& site) {
  const std::vector<Prop> props = SiteProps();
  site.Scatter(props, {{1.0, 1.0}, {43.0, 19.0}, 0.0}, 260);
  site.Scatter(props, {{0.0, 20.5}, {8.0, 27.5}, 0.0}, 30);
  site.Scatter(props, {{14.0, 26.5}, {34.0, 29.5}, 0.0}, 40);
  site.Scatter(props, {{1.0, 1.0}, {43.0, 19.0}, kStorey}, 220);
  site.Scatter(props, {{37.0, 20.5}, {43.0, 27.0}, kStorey}, 15);
}

}  // namespace

World MakeConstruction(std::uint32_t seed) {
  World world;
  world.name = "construction";
  world.route = Route();
  Site site(world.route, world.closed, seed);
  AddTerrain(site.mesh, seed);
  AddUpperFloor(site.mesh);
  AddRamp(site.mesh);
  AddColumns(site);
  AddPartialWalls(site);
  ReserveWalls(site);
  AddFormwork(site);
  AddClutter(site);
  AddCables(site);
  AddSurroundings(site, seed);
  site.mesh.Undulate(0.008, 1.1, seed);
  world.mesh = site.mesh.mesh();
  world.people = {
      {{{9.0, 5.2, 0.0}, {35.0, 5.2, 0.0}, {35.0, 6.8, 0.0}, {9.0, 6.8, 0.0}}, 1.2, 0.0},
      {{{15.0, 11.3, 0.0}, {35.0, 11.3, 0.0}, {35.0, 12.7, 0.0}, {15.0, 12.7, 0.0}}, 1.0, 12.0},
      {{{15.0, 17.3, kStorey}, {37.0, 17.3, kStorey}, {37.0, 18.7, kStorey}, {15.0, 18.7, kStorey}},
       1.1,
       4.0}};
  return world;
}

}  // namespace hv::sim
