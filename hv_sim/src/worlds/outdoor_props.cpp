#include "outdoor_props.h"

#include <array>
#include <cmath>

#include "building.h"

namespace hv::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kStorey = 3.3;

std::uint32_t Key(Random& random) { return static_cast<std::uint32_t>(random.Bits()); }

void AddWheels(MeshBuilder& mesh, const Pose& at, double half_x, double half_y) {
  mesh.SetReflectivity(0.08);
  for (const double x : {-half_x, half_x}) {
    for (const double y : {-half_y, half_y}) {
      mesh.AddCylinder(at * Vector3d(x, y - 0.1, 0.31), at * Vector3d(x, y + 0.1, 0.31), 0.31, 14);
    }
  }
}

/// The four outer walls of one storey.
void AddStorey(MeshBuilder& mesh, const Pose& at, const Vector2d& half, int floor) {
  const std::array<Vector2d, 4> corners = {
      Vector2d(-half.x(), -half.y()), Vector2d(half.x(), -half.y()), Vector2d(half.x(), half.y()),
      Vector2d(-half.x(), half.y())};
  const auto world = [&at](const Vector2d& corner) -> Vector2d {
    return (at * Vector3d(corner.x(), corner.y(), 0.0)).head<2>();
  };
  for (std::size_t side = 0; side < 4; ++side) {
    Wall wall;
    wall.from = world(corners[side]);
    wall.to = world(corners[(side + 1) % 4]);
    wall.base = at.translation().z() + kStorey * floor;
    wall.height = kStorey;
    wall.thickness = 0.3;
    wall.openings = Windows((wall.to - wall.from).norm(), 1.3, 3.6, 1.8, 0.9, 2.5);
    AddWall(mesh, wall);
  }
}

void AddEntrance(MeshBuilder& mesh, const Pose& at, double front) {
  mesh.SetReflectivity(0.45);
  for (int step = 0; step < 3; ++step) {
    const double reach = 1.8 - 0.4 * step;
    mesh.AddBox(at, Vector3d(-1.6, front - reach, -0.6), Vector3d(1.6, front, 0.15 * (step + 1)));
  }
  mesh.AddBox(at, Vector3d(-1.8, front - 2.0, 2.8), Vector3d(1.8, front, 3.0));
  for (const double x : {-1.6, 1.6}) {
    mesh.AddCylinder(at * Vector3d(x, front - 1.7, 0.0), at * Vector3d(x, front - 1.7, 2.8), 0.09);
  }
}

}  // namespace

void AddTree(MeshBuilder& mesh, const Pose& at, Random& random) {
  const double height = random.Uniform(2.2, 3.4);
  const double crown = random.Uniform(1.3, 2.1);
  const double trunk = random.Uniform(0.1, 0.22);
  mesh.SetReflectivity(0.3);
  const Vector3d foot = at * Vector3d(0.0, 0.0, -0.3);
  const Vector3d fork = at * Vector3d(random.Uniform(-0.2, 0.2), random.Uniform(-0.2, 0.2), height);
  mesh.AddFrustum(foot, fork, trunk, 0.6 * trunk, 9);
  for (int branch = 0; branch < 6; ++branch) {
    const double turn = random.Uniform(-M_PI, M_PI);
    const Vector3d reach(crown * std::cos(turn), crown * std::sin(turn), random.Uniform(0.6, 2.0));
    const Vector3d tip = fork + 0.7 * reach;
    mesh.AddFrustum(fork - random.Uniform(0.0, 0.7) * Vector3d::UnitZ(), tip, 0.35 * trunk, 0.02,
                    5);
    mesh.SetReflectivity(0.5);
    mesh.AddLeaves(tip, {0.5 * crown, 0.5 * crown, 0.45 * crown}, 70, 0.22, random);
    mesh.SetReflectivity(0.3);
  }
  mesh.SetReflectivity(0.5);
  mesh.AddLeaves(fork + 0.7 * crown * Vector3d::UnitZ(), {crown, crown, 0.9 * crown}, 240, 0.24,
                 random);
}

void AddConifer(MeshBuilder& mesh, const Pose& at, Random& random) {
  const double height = random.Uniform(5.0, 9.0);
  mesh.SetReflectivity(0.25);
  mesh.AddFrustum(at * Vector3d(0.0, 0.0, -0.3), at * Vector3d(0.0, 0.0, height), 0.16, 0.02, 8);
  mesh.SetReflectivity(0.45);
  for (double z = 1.9; z < height; z += 0.6) {
    const double reach = 1.5 * (1.0 - z / (height + 0.5));
    mesh.AddLeaves(at * Vector3d(0.0, 0.0, z), {reach, reach, 0.25}, 55, 0.2, random);
  }
}

void AddBush(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(0.5);
  const double height = random.Uniform(0.4, 0.9);
  mesh.AddLeaves(at * Vector3d(0.0, 0.0, 0.5 * height), {0.65, 0.65, 0.6 * height}, 200, 0.12,
                 random);
}

void AddStreetLamp(MeshBuilder& mesh, const Pose& at, Random& /*random*/) {
  mesh.SetReflectivity(0.4);
  mesh.AddFrustum(at * Vector3d(0.0, 0.0, -0.2), at * Vector3d(0.0, 0.0, 5.5), 0.09, 0.05, 10);
  mesh.AddCylinder(at * Vector3d(0.0, 0.0, 5.4), at * Vector3d(1.2, 0.0, 5.7), 0.035, 8);
  mesh.AddBox(at * Upright({1.3, 0.0, 5.7}), Vector3d(0.6, 0.2, 0.1));
  mesh.AddBox(at * Upright({0.0, 0.0, 0.3}), Vector3d(0.26, 0.26, 0.7));
}

void AddSign(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(0.9);
  mesh.AddCylinder(at * Vector3d(0.0, 0.0, -0.2), at * Vector3d(0.0, 0.0, 2.3), 0.03, 8);
  const Pose board = at * MakePose(RotationFromRpy(0.0, random.Uniform(-0.05, 0.05), 0.0),
                                   Vector3d(0.03, 0.0, 2.1));
  mesh.AddBox(board, Vector3d(0.02, 0.6, random.Uniform(0.4, 0.8)));
}

void AddBollard(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(0.35);
  const double height = random.Uniform(0.6, 0.9);
  mesh.AddCylinder(at * Vector3d(0.0, 0.0, -0.2), at * Vector3d(0.0, 0.0, height), 0.08, 10);
  mesh.AddEllipsoid(at * Upright({0.0, 0.0, height}), {0.1, 0.1, 0.1}, 0.0, 1);
}

void AddBench(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(0.45);
  for (const double x : {-0.2, -0.05, 0.1, 0.25}) {
    mesh.AddBox(at * Upright({x, 0.0, 0.45}), Vector3d(0.11, 1.6, 0.04));
  }
  for (const double z : {0.6, 0.75}) {
    mesh.AddBox(at * MakePose(RotationFromRpy(0.0, -0.25, 0.0), Vector3d(-0.3, 0.0, z)),
                Vector3d(0.03, 1.6, 0.1));
  }
  for (const double y : {-0.7, 0.7}) {
    mesh.AddBox(at, Vector3d(-0.25, y - 0.04, -0.2), Vector3d(0.25, y + 0.04, 0.43));
  }
  if (random.Chance(0.3))
    mesh.AddFrustum(at * Vector3d(0.0, 1.1, -0.1), at * Vector3d(0.0, 1.1, 0.8), 0.2, 0.24);
}

void AddCar(MeshBuilder& mesh, const Pose& at, Random& random) {
  const double paint = random.Uniform(0.08, 0.7);
  mesh.SetReflectivity(paint);
  mesh.AddBox(at, Vector3d(-2.1, -0.85, 0.28), Vector3d(2.1, 0.85, 0.8));
  mesh.AddEllipsoid(at * Upright({-0.15, 0.0, 0.8}), {1.6, 0.78, 0.68}, 0.0, 1);
  mesh.AddEllipsoid(at * Upright({1.5, 0.0, 0.75}), {0.75, 0.82, 0.2}, 0.0, 1);
  for (const double y : {-0.95, 0.95})
    mesh.AddBox(at * Upright({0.65, y, 0.95}), Vector3d(0.1, 0.18, 0.12));
  AddWheels(mesh, at, 1.3, 0.8);
}

void AddBoulder(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(0.35);
  const double size = random.Uniform(0.25, 0.5);
  mesh.AddEllipsoid(at, {1.2 * size, size, 0.9 * size}, 0.3, Key(random));
}

void AddHouse(MeshBuilder& mesh, const Pose& at, double length, double depth, int floors,
              Random& random) {
  const Vector2d half(0.5 * length, 0.5 * depth);
  mesh.SetReflectivity(random.Uniform(0.4, 0.7));
  for (int floor = 0; floor < floors; ++floor) AddStorey(mesh, at, half, floor);
  const double top = kStorey * floors;
  // Foundation below uneven ground, panes set back behind the windows, and eaves.
  mesh.AddBox(at, Vector3d(-half.x() - 0.15, -half.y() - 0.15, -2.5),
              Vector3d(half.x() + 0.15, half.y() + 0.15, 0.0));
  mesh.SetReflectivity(0.12);
  mesh.AddBox(at, Vector3d(-half.x() + 0.5, -half.y() + 0.5, 0.0),
              Vector3d(half.x() - 0.5, half.y() - 0.5, top));
  mesh.SetReflectivity(0.3);
  mesh.AddBox(at, Vector3d(-half.x() - 0.6, -half.y() - 0.6, top),
              Vector3d(half.x() + 0.6, half.y() + 0.6, top + 0.35));
  for (const double x : {-half.x() + 0.5, half.x() - 0.5}) {
    for (const double y : {-half.y() - 0.22, half.y() + 0.22}) {
      mesh.AddCylinder(at * Vector3d(x, y, -0.5), at * Vector3d(x, y, top), 0.06, 8);
    }
  }
  for (int unit = 0; unit < 6; ++unit) {
    const double x = random.Uniform(-half.x() + 1.0, half.x() - 1.0);
    const double z =
        kStorey * static_cast<double>(random.Bits() % static_cast<unsigned>(floors)) + 2.8;
    mesh.AddBox(at * Upright({x, half.y() + 0.35, z}), Vector3d(0.8, 0.35, 0.55));
  }
  AddEntrance(mesh, at, -half.y() - 0.15);
}

}  // namespace hv::sim
