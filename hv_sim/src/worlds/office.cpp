#include <algorithm>
#include <array>
#include <cmath>

#include "building.h"
#include "furniture.h"
#include "worlds.h"

namespace hv::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Two corridors along x (A south, B north) joined by three cross corridors; rooms around them.
constexpr double kLength = 40.0;
constexpr double kDepth = 26.0;
constexpr double kHeight = 2.8;
constexpr double kSouthA = 6.5;
constexpr double kNorthA = 8.7;
constexpr double kSouthB = 17.3;
constexpr double kNorthB = 19.5;
constexpr double kWest = 2.2;
constexpr double kMiddleWest = 19.0;
constexpr double kMiddleEast = 21.2;
constexpr double kEast = 37.8;

std::vector<Vector3d> Route() {
  return {{1.1, 7.6, 0.0},    {16.5, 7.6, 0.0},   {16.5, 5.2, 0.0},  {18.4, 4.6, 0.0},
          {18.4, 1.4, 0.0},   {14.6, 1.4, 0.0},   {14.6, 4.6, 0.0},  {16.5, 5.2, 0.0},
          {16.5, 7.6, 0.0},   {20.1, 7.6, 0.0},   {20.1, 18.4, 0.0}, {10.75, 18.4, 0.0},
          {10.75, 7.6, 0.0},  {38.9, 7.6, 0.0},   {38.9, 18.4, 0.0}, {28.0, 18.4, 0.0},
          {28.0, 22.75, 0.0}, {16.0, 22.75, 0.0}, {16.0, 18.4, 0.0}, {1.1, 18.4, 0.0}};
}

/// A wall along x or y at `fixed` with doors centred at `doors`; wide ones are on the route.
struct RoomWall {
  bool along_x;
  double fixed, from, to;
  std::vector<double> doors;
  std::vector<double> wide_doors;
};

void AddRoomWall(Site& site, const RoomWall& plan) {
  Wall wall;
  wall.from = plan.along_x ? Vector2d(plan.from, plan.fixed) : Vector2d(plan.fixed, plan.from);
  wall.to = plan.along_x ? Vector2d(plan.to, plan.fixed) : Vector2d(plan.fixed, plan.to);
  for (const double door : plan.doors) {
    wall.openings.push_back({door - 0.5 - plan.from, door + 0.5 - plan.from, 0.0, 2.1});
    const Vector3d hinge = plan.along_x ? Vector3d(door - 0.43, plan.fixed, 0.0)
                                        : Vector3d(plan.fixed, door - 0.43, 0.0);
    const double closed = plan.along_x ? 0.0 : 0.5 * M_PI;
    // Leaves stay in the opening or swing into the room, away from the corridors.
    const bool into_plus = plan.fixed == kNorthA || plan.fixed == kNorthB;
    const double swing = site.random.Chance(0.4) ? 0.0 : site.random.Uniform(0.3, 1.5);
    AddDoorLeaf(site.mesh, hinge, closed + (into_plus ? swing : -swing), 0.86);
  }
  for (const double door : plan.wide_doors) {
    wall.openings.push_back({door - 0.9 - plan.from, door + 0.9 - plan.from, 0.0, 2.2});
  }
  std::sort(wall.openings.begin(), wall.openings.end(),
            [](const Opening& a, const Opening& b) { return a.from < b.from; });
  AddWall(site.mesh, wall);
}

void AddOuterWalls(MeshBuilder& mesh) {
  const std::array<Vector2d, 4> corners = {Vector2d(0.0, 0.0), Vector2d(kLength, 0.0),
                                           Vector2d(kLength, kDepth), Vector2d(0.0, kDepth)};
  for (std::size_t i = 0; i < 4; ++i) {
    Wall wall;
    wall.from = corners[i];
    wall.to = corners[(i + 1) % 4];
    wall.thickness = 0.3;
    wall.openings = Windows((wall.to - wall.from).norm(), 1.2, 3.3, 1.6);
    AddWall(mesh, wall);
  }
}

void AddInnerWalls(Site& site) {
  const std::vector<RoomWall> walls = {
      {true, kSouthA, 0.0, kLength, {3.2, 9.5, 23.0, 30.0, 36.0}, {16.5}},
      {true, kNorthA, kWest, kMiddleWest, {5.0, 16.0}, {10.75}},
      {true, kNorthA, kMiddleEast, kEast, {24.0, 29.5, 35.0}, {}},
      {true, kSouthB, kWest, kMiddleWest, {5.0, 16.0}, {10.75}},
      {true, kSouthB, kMiddleEast, kEast, {24.0, 29.5, 35.0}, {}},
      {true, kNorthB, 0.0, kLength, {4.0, 11.0, 35.0}, {16.0, 28.0}},
      {false, kWest, kNorthA, kSouthB, {}, {}},
      {false, kMiddleWest, kNorthA, kSouthB, {}, {}},
      {false, kMiddleEast, kNorthA, kSouthB, {11.0, 15.0}, {}},
      {false, kEast, kNorthA, kSouthB, {}, {}},
      {true, 13.0, kWest, 8.0, {}, {}},
      {true, 13.0, 13.5, kMiddleWest, {}, {}},
      {true, 13.0, kMiddleEast, kEast, {29.5}, {}}};
  for (const RoomWall& wall : walls) AddRoomWall(site, wall);
  for (const double x : {6.5, 13.0, 20.0, 27.0, 33.5}) {
    AddRoomWall(site, {false, x, 0.0, kSouthA, {}, {}});
  }
  for (const double x : {8.0, 14.0, 30.0}) AddRoomWall(site, {false, x, kNorthB, kDepth, {}, {}});
  for (const double x : {8.0, 13.5, 27.0, 32.0}) {
    AddRoomWall(site, {false, x, kNorthA, kSouthB, {}, {}});
  }
}

void FurnishRoom(Site& site, const Vector2d& low, const Vector2d& high) {
  constexpr double kGap = 0.55;  // centre of wall furniture to the wall
  const Vector2d a = low + Vector2d(kGap, kGap);
  const Vector2d b = high - Vector2d(kGap, kGap);
  const std::vector<Prop> along_walls = WallFurniture();
  const auto at = [](double x, double y) { return Vector3d(x, y, 0.0); };
  site.LineUp(along_walls, at(a.x(), a.y()), at(b.x(), a.y()));
  site.LineUp(along_walls, at(b.x(), a.y() + 0.6), at(b.x(), b.y()));
  site.LineUp(along_walls, at(b.x() - 0.6, b.y()), at(a.x(), b.y()));
  site.LineUp(along_walls, at(a.x(), b.y() - 0.6), at(a.x(), a.y()));
  const int tries = static_cast<int>((high - low).prod());
  site.Scatter(LooseFurniture(), {a, b, 0.0}, tries);
}

/// Doors stay passable: nothing stands right behind them.
void ReserveDoorways(Site& site) {
  for (const double x : {3.2, 9.5, 23.0, 30.0, 36.0}) site.Reserve({x, kSouthA - 0.6, 0.0}, 0.6);
  for (const double x : {5.0, 16.0, 24.0, 29.5, 35.0}) {
    site.Reserve({x, kNorthA + 0.6, 0.0}, 0.6);
    site.Reserve({x, kSouthB - 0.6, 0.0}, 0.6);
  }
  for (const double x : {4.0, 11.0, 35.0}) site.Reserve({x, kNorthB + 0.6, 0.0}, 0.6);
}

void FurnishRooms(Site& site) {
  site.Place({AddTable, 0.97}, {16.5, 3.0, 0.0}, 0.3);
  const auto row = [&site](const std::vector<double>& xs, double low, double high) {
    for (std::size_t i = 1; i < xs.size(); ++i) {
      FurnishRoom(site, {xs[i - 1], low}, {xs[i], high});
    }
  };
  row({0.0, 6.5, 13.0, 20.0, 27.0, 33.5, 40.0}, 0.0, kSouthA);
  row({0.0, 8.0, 14.0, 30.0, 40.0}, kNorthB, kDepth);
  row({8.0, 13.5}, kNorthA, kSouthB);
  for (const double low : {kNorthA, 13.0}) {
    const double high = low < 10.0 ? 13.0 : kSouthB;
    row({kWest, 8.0}, low, high);
    row({13.5, kMiddleWest}, low, high);
    row({kMiddleEast, 27.0, 32.0, kEast}, low, high);
  }
}

void FurnishCorridors(Site& site) {
  const std::vector<Prop> props = CorridorFurniture();
  for (const double y : {kSouthA, kSouthB}) {
    site.Scatter(props, {{2.5, y + 0.15}, {37.5, y + 0.35}, 0.0}, 40);
    site.Scatter(props, {{2.5, y + 1.85}, {37.5, y + 2.05}, 0.0}, 40);
    site.mesh.SetReflectivity(0.6);
    AddServices(site.mesh, {0.5, y + 0.5, 2.55}, {39.5, y + 0.5, 2.55}, site.random);
  }
  site.mesh.SetReflectivity(0.6);
  for (const double x : {1.1, 20.1, 38.9}) {
    AddServices(site.mesh, {x + 0.5, 9.0, 2.6}, {x + 0.5, 17.0, 2.6}, site.random);
  }
}

/// Beams, lamps and ducts under the ceiling.
void AddCeiling(Site& site) {
  MeshBuilder& mesh = site.mesh;
  mesh.SetReflectivity(0.8);
  AddFloor(mesh, {{0.0, 0.0}, {kLength, kDepth}, kHeight});
  for (double x = 4.0; x < kLength; x += 6.0) {
    mesh.AddBox(Upright({x, 13.0, kHeight - 0.1}), Vector3d(0.25, kDepth, 0.2));
  }
  mesh.SetReflectivity(0.9);
  for (double x = 2.0; x < kLength; x += 3.0) {
    for (const double y : {3.2, 7.6, 11.0, 15.2, 18.4, 22.8}) {
      if (site.random.Chance(0.2)) continue;
      const Pose lamp = Upright({x, y, kHeight - site.random.Uniform(0.08, 0.3)},
                                site.random.Uniform(-0.05, 0.05));
      mesh.AddBox(lamp, Vector3d(1.2, 0.15, 0.07));
    }
  }
}

}  // namespace

World MakeOffice(std::uint32_t seed) {
  World world;
  world.name = "office";
  world.route = Route();
  Site site(world.route, world.closed, seed);
  site.mesh.SetReflectivity(0.3);
  AddFloor(site.mesh, {{0.0, 0.0}, {kLength, kDepth}, 0.0});
  site.mesh.SetReflectivity(0.75);
  AddOuterWalls(site.mesh);
  AddInnerWalls(site);
  ReserveDoorways(site);
  FurnishRooms(site);
  FurnishCorridors(site);
  AddCeiling(site);
  site.mesh.Undulate(0.004, 1.3, seed);
  world.mesh = site.mesh.mesh();
  world.people = {
      {{{3.0, 7.15, 0.0}, {36.0, 7.15, 0.0}, {36.0, 8.05, 0.0}, {3.0, 8.05, 0.0}}, 1.2, 0.0},
      {{{5.0, 17.95, 0.0}, {35.0, 17.95, 0.0}, {35.0, 18.85, 0.0}, {5.0, 18.85, 0.0}}, 1.0, 20.0},
      {{{19.6, 9.0, 0.0}, {20.6, 9.0, 0.0}, {20.6, 17.0, 0.0}, {19.6, 17.0, 0.0}}, 0.9, 5.0}};
  return world;
}

}  // namespace hv::sim
