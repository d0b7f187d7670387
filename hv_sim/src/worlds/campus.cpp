#include <algorithm>
#include <array>
#include <cmath>

#include "building.h"
#include "hv_sim/route.h"
#include "outdoor_props.h"
#include "site_props.h"
#include "worlds.h"

namespace hv::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kHalf = 105.0;  ///< half of the edge of the grounds [m]

double Height(double x, double y) {
  constexpr std::uint32_t kRelief = 77;
  return 1.8 * SmoothNoise({x / 60.0, y / 60.0, 0.5}, kRelief) +
         0.35 * SmoothNoise({x / 23.0, y / 23.0, 0.5}, kRelief + 1);
}

Vector3d OnGround(double x, double y) { return {x, y, Height(x, y)}; }

/// Paths between four blocks; the south-eastern one is walked around twice.
std::vector<Vector3d> Route() {
  const std::vector<Vector3d> corners = {
      {-70.0, -70.0, 0.0}, {70.0, -70.0, 0.0}, {70.0, 0.0, 0.0},  {0.0, 0.0, 0.0},
      {0.0, -70.0, 0.0},   {70.0, -70.0, 0.0}, {70.0, 70.0, 0.0}, {-70.0, 70.0, 0.0}};
  std::vector<Vector3d> route = SampleRoute(corners, true, 4.0, 1.0);
  route.pop_back();  // the first point again
  for (Vector3d& point : route) point.z() = Height(point.x(), point.y());
  return route;
}

void AddGround(MeshBuilder& mesh, std::uint32_t seed) {
  mesh.SetReflectivity(0.3);
  constexpr int kCells = 210;
  mesh.AddPatch(kCells, kCells, [seed](double s, double t) -> Vector3d {
    const double x = kHalf * (2.0 * s - 1.0);
    const double y = kHalf * (2.0 * t - 1.0);
    // Lawns are rougher than the paths along x and y = -70, 0, 70.
    const auto off_path = [](double c) {
      return std::min({std::abs(c + 70.0), std::abs(c), std::abs(c - 70.0)}) - 2.0;
    };
    const double lawn = std::clamp(std::min(off_path(x), off_path(y)) / 2.0, 0.0, 1.0);
    return {x, y, Height(x, y) + 0.06 * lawn * SmoothNoise({x / 1.7, y / 1.7, 0.0}, seed)};
  });
}

struct House {
  double x, y, yaw, length, depth;
  int floors;
};

void AddHouses(Site& site) {
  constexpr std::array<House, 9> kHouses = {{{-38.0, -52.0, 0.05, 44.0, 14.0, 3},
                                             {-50.0, -22.0, 1.5, 26.0, 13.0, 2},
                                             {-16.0, -24.0, 0.3, 20.0, 16.0, 4},
                                             {36.0, -50.0, -0.04, 36.0, 16.0, 2},
                                             {40.0, -20.0, 0.0, 42.0, 15.0, 4},
                                             {30.0, 36.0, 0.8, 34.0, 18.0, 3},
                                             {-34.0, 20.0, 3.1, 46.0, 15.0, 3},
                                             {-36.0, 52.0, 0.1, 24.0, 20.0, 5},
                                             {90.0, 10.0, 1.57, 50.0, 14.0, 3}}};
  for (const House& house : kHouses) {
    const Pose at = Upright(OnGround(house.x, house.y), house.yaw);
    AddHouse(site.mesh, at, house.length, house.depth, house.floors, site.random);
    for (double along = -0.5 * house.length; along <= 0.5 * house.length; along += 2.0) {
      site.Reserve(at * Vector3d(along, 0.0, 0.0), 0.5 * house.depth + 1.5);
    }
  }
}

/// Rows of trees, lamps and signs on both sides of the paths, cars along one of them.
void AddAlleys(Site& site) {
  const std::vector<Prop> props = {{AddTree, 0.9},     {AddTree, 0.9},    {AddStreetLamp, 0.25},
                                   {AddBush, 0.8},     {AddBench, 0.95},  {AddSign, 0.35},
                                   {AddBollard, 0.15}, {AddConifer, 1.2}, {AddBoulder, 0.7}};
  for (const double path : {-70.0, 0.0, 70.0}) {
    for (const double side : {-3.4, 3.4}) {
      for (double s = -95.0; s < 95.0; s += site.random.Uniform(4.0, 9.0)) {
        const double across = path + side + site.random.Uniform(-0.5, 0.5);
        const double yaw = side > 0.0 ? -0.5 * M_PI : 0.5 * M_PI;
        site.Place(props[site.random.Bits() % props.size()], OnGround(s, across), yaw);
        site.Place(props[site.random.Bits() % props.size()], OnGround(across, s), yaw + 0.5 * M_PI);
      }
    }
  }
  for (double s = -60.0; s < 60.0; s += 5.6) {
    if (site.random.Chance(0.3)) continue;
    site.Place({AddCar, 2.3}, OnGround(s, -74.5), site.random.Uniform(-0.05, 0.05));
    site.Place({AddCar, 2.3}, OnGround(75.5, s), 0.5 * M_PI + site.random.Uniform(-0.05, 0.05));
  }
}

void AddLawns(Site& site) {
  const std::vector<Prop> props = {{AddTree, 1.6}, {AddTree, 1.6},    {AddConifer, 1.4},
                                   {AddBush, 0.8}, {AddBoulder, 0.7}, {AddBench, 0.95}};
  for (int i = 0; i < 420; ++i) {
    const double x = site.random.Uniform(-100.0, 100.0);
    const double y = site.random.Uniform(-100.0, 100.0);
    site.Place(props[site.random.Bits() % props.size()], OnGround(x, y),
               site.random.Uniform(-M_PI, M_PI));
  }
}

/// Poles with sagging lines along the northern path, and a fence around the grounds.
void AddLines(Site& site) {
  MeshBuilder& mesh = site.mesh;
  mesh.SetReflectivity(0.3);
  for (double x = -90.0; x < 90.0; x += 30.0) {
    const Vector3d foot = OnGround(x, 75.5);
    const Vector3d next = OnGround(x + 30.0, 75.5);
    mesh.AddCylinder(foot, foot + 7.0 * Vector3d::UnitZ(), 0.13, 10);
    for (const double arm : {-0.6, 0.0, 0.6}) {
      const Vector3d wire(0.0, arm, 6.7);
      mesh.AddCable(foot + wire, next + wire, 0.8, 0.02);
    }
  }
  const double edge = kHalf - 2.0;
  for (double s = -edge; s < edge; s += 8.0) {
    const double to = std::min(edge, s + 8.0);
    for (const double side : {-edge, edge}) {
      AddRailing(mesh, {OnGround(s, side), OnGround(to, side)});
      AddRailing(mesh, {OnGround(side, s), OnGround(side, to)});
    }
  }
}

PersonPath Walkway(const Vector2d& from, const Vector2d& to, double speed) {
  constexpr double kAside = 1.0;
  const Vector2d along = (to - from).normalized();
  const Vector2d left = kAside * Vector2d(-along.y(), along.x());
  PersonPath path;
  path.speed = speed;
  const int steps = static_cast<int>((to - from).norm() / 3.0);
  for (int i = 0; i <= steps; ++i) {
    const Vector2d at = from + (to - from) * i / steps - left;
    path.waypoints.push_back(OnGround(at.x(), at.y()));
  }
  for (int i = steps; i >= 0; --i) {
    const Vector2d at = from + (to - from) * i / steps + left;
    path.waypoints.push_back(OnGround(at.x(), at.y()));
  }
  return path;
}

}  // namespace

World MakeCampus(std::uint32_t seed) {
  World world;
  world.name = "campus";
  world.route = Route();
  Site site(world.route, world.closed, seed);
  AddGround(site.mesh, seed);
  AddHouses(site);
  AddAlleys(site);
  AddLawns(site);
  AddLines(site);
  site.mesh.Undulate(0.006, 1.3, seed);
  world.mesh = site.mesh.mesh();
  world.people = {Walkway({-60.0, -70.0}, {20.0, -70.0}, 1.3),
                  Walkway({70.0, -60.0}, {70.0, 40.0}, 1.1), Walkway({5.0, 0.0}, {65.0, 0.0}, 1.2),
                  Walkway({0.0, -60.0}, {0.0, -5.0}, 0.9),
                  Walkway({-60.0, 70.0}, {50.0, 70.0}, 1.4)};
  return world;
}

}  // namespace hv::sim
