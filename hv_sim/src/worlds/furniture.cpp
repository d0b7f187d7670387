#include "furniture.h"

#include <algorithm>
#include <cmath>

namespace hv::sim {
namespace {

using Eigen::Vector3d;

/// Box between two corners in the frame of the prop.
void Block(MeshBuilder& mesh, const Pose& at, const Vector3d& low, const Vector3d& high) {
  mesh.AddBox(at, low, high);
}

void Rod(MeshBuilder& mesh, const Pose& at, const Vector3d& from, const Vector3d& to,
         double radius) {
  mesh.AddCylinder(at * from, at * to, radius, 8);
}

void AddLegs(MeshBuilder& mesh, const Pose& at, double half_x, double half_y, double height) {
  for (const double x : {-half_x, half_x}) {
    for (const double y : {-half_y, half_y}) Rod(mesh, at, {x, y, 0.0}, {x, y, height}, 0.025);
  }
}

/// A carton turned anyhow, sagging a little to one side.
void AddCarton(MeshBuilder& mesh, const Pose& at, double height, Random& random) {
  mesh.SetReflectivity(random.Uniform(0.4, 0.7));
  const Vector3d size(random.Uniform(0.2, 0.32), random.Uniform(0.2, 0.35), height);
  const Pose tilted =
      MakePose(RotationFromRpy(random.Uniform(-0.05, 0.05), random.Uniform(-0.05, 0.05),
                               random.Uniform(-M_PI, M_PI)),
               Vector3d(0.0, 0.0, 0.5 * height));
  mesh.AddBox(at * tilted, size);
}

}  // namespace

void AddDesk(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(0.55);
  Block(mesh, at, {-0.35, -0.7, 0.71}, {0.35, 0.7, 0.74});
  AddLegs(mesh, at, 0.3, 0.65, 0.71);
  Block(mesh, at, {-0.3, 0.25, 0.05}, {0.25, 0.62, 0.6});
  mesh.SetReflectivity(0.15);
  const Pose screen =
      at * Upright({-0.2, random.Uniform(-0.4, 0.1), 0.95}, random.Uniform(-0.4, 0.4));
  mesh.AddBox(screen, Vector3d(0.03, 0.52, 0.32));
  mesh.AddCylinder(screen.translation() - 0.2 * Vector3d::UnitZ(), screen.translation(), 0.03, 8);
  mesh.SetReflectivity(0.8);
  Block(mesh, at, {0.05, -0.5, 0.74}, {0.26, -0.2, 0.74 + random.Uniform(0.01, 0.2)});
}

void AddTable(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(0.6);
  Block(mesh, at, {-0.5, -0.8, 0.7}, {0.5, 0.8, 0.74});
  AddLegs(mesh, at, 0.42, 0.72, 0.7);
  const Vector3d vase(random.Uniform(-0.3, 0.3), random.Uniform(-0.5, 0.5), 0.74);
  mesh.AddFrustum(at * vase, at * (vase + 0.25 * Vector3d::UnitZ()), 0.05, 0.08, 10);
  mesh.AddLeaves(at * (vase + 0.4 * Vector3d::UnitZ()), {0.15, 0.15, 0.2}, 40, 0.06, random);
}

void AddChair(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(random.Uniform(0.1, 0.4));
  Block(mesh, at, {-0.22, -0.22, 0.44}, {0.22, 0.22, 0.5});
  const Pose back = at * MakePose(RotationFromRpy(0.0, -0.2, 0.0), Vector3d(-0.25, 0.0, 0.75));
  mesh.AddBox(back, Vector3d(0.05, 0.42, 0.5));
  Rod(mesh, at, {0.0, 0.0, 0.08}, {0.0, 0.0, 0.44}, 0.03);
  for (int leg = 0; leg < 5; ++leg) {
    const double turn = 0.4 * M_PI * leg;
    Rod(mesh, at, {0.0, 0.0, 0.1}, {0.28 * std::cos(turn), 0.28 * std::sin(turn), 0.05}, 0.02);
  }
}

void AddShelf(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(0.5);
  Block(mesh, at, {-0.16, -0.5, 0.0}, {-0.14, 0.5, 1.9});
  for (const double y : {-0.5, 0.48}) Block(mesh, at, {-0.16, y, 0.0}, {0.16, y + 0.02, 1.9});
  for (int level = 0; level < 6; ++level) {
    const double z = 0.05 + 0.36 * level;
    mesh.SetReflectivity(0.5);
    Block(mesh, at, {-0.16, -0.5, z}, {0.16, 0.5, z + 0.02});
    if (level == 5) break;
    double y = -0.46;
    while (y < 0.4) {
      const double width = random.Uniform(0.05, 0.25);
      mesh.SetReflectivity(random.Uniform(0.2, 0.9));
      Block(
          mesh, at, {-0.14, y, z + 0.02},
          {random.Uniform(-0.02, 0.14), std::min(0.46, y + width), z + random.Uniform(0.15, 0.32)});
      y += width + (random.Chance(0.3) ? 0.15 : 0.005);
    }
  }
}

void AddCabinet(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(0.65);
  const double height = random.Uniform(0.8, 1.7);
  Block(mesh, at, {-0.17, -0.4, 0.05}, {0.15, 0.4, height});
  for (double z = 0.1; z + 0.3 < height; z += 0.35) {
    Block(mesh, at, {0.15, -0.38, z}, {0.17, 0.38, z + 0.32});
    Rod(mesh, at, {0.19, -0.08, z + 0.25}, {0.19, 0.08, z + 0.25}, 0.01);
  }
  if (random.Chance(0.5)) AddCarton(mesh, at * Upright({0.0, 0.1, height}, 0.3), random);
}

void AddPlant(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(0.35);
  mesh.AddFrustum(at.translation(), at * Vector3d(0.0, 0.0, 0.35), 0.13, 0.18, 12);
  Rod(mesh, at, {0.0, 0.0, 0.3}, {0.03, 0.02, 0.9}, 0.02);
  mesh.SetReflectivity(0.6);
  const double height = random.Uniform(0.9, 1.3);
  mesh.AddLeaves(at * Vector3d(0.0, 0.0, height), {0.32, 0.32, 0.5}, 160, 0.12, random);
}

void AddBin(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(random.Uniform(0.1, 0.5));
  mesh.AddFrustum(at.translation(), at * Vector3d(0.0, 0.0, random.Uniform(0.3, 0.6)), 0.12, 0.16);
}

void AddCarton(MeshBuilder& mesh, const Pose& at, Random& random) {
  const double height = random.Uniform(0.15, 0.4);
  AddCarton(mesh, at, height, random);
}

void AddCartonStack(MeshBuilder& mesh, const Pose& at, Random& random) {
  const int count = 2 + static_cast<int>(random.Bits() % 4);
  double top = 0.0;
  for (int i = 0; i < count; ++i) {
    const double height = random.Uniform(0.2, 0.35);
    const Vector3d shift(random.Uniform(-0.06, 0.06), random.Uniform(-0.06, 0.06), top);
    AddCarton(mesh, at * Upright(shift), height, random);
    top += height - 0.01;
  }
}

void AddCoatStand(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(0.2);
  Rod(mesh, at, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.75}, 0.025);
  for (int arm = 0; arm < 6; ++arm) {
    const double turn = M_PI / 3.0 * arm;
    const Vector3d out(std::cos(turn), std::sin(turn), 0.0);
    Rod(mesh, at, {0.0, 0.0, 1.6}, 0.18 * out + Vector3d(0.0, 0.0, 1.75), 0.012);
    if (random.Chance(0.5)) continue;
    const Pose coat = at * Upright(0.15 * out + Vector3d(0.0, 0.0, 1.2), turn);
    mesh.AddEllipsoid(coat, {0.07, 0.16, 0.4}, 0.25, static_cast<std::uint32_t>(random.Bits()));
  }
}

void AddRadiator(MeshBuilder& mesh, const Pose& at, Random& /*random*/) {
  mesh.SetReflectivity(0.75);
  for (int rib = 0; rib < 10; ++rib) {
    const double y = -0.45 + 0.1 * rib;
    Block(mesh, at, {-0.05, y - 0.035, 0.15}, {0.05, y + 0.035, 0.7});
  }
  Rod(mesh, at, {0.0, -0.55, 0.2}, {0.0, 0.55, 0.2}, 0.02);
  Rod(mesh, at, {0.0, 0.55, 0.0}, {0.0, 0.55, 0.2}, 0.02);
}

void AddExtinguisher(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(0.3);
  const double height = random.Uniform(0.3, 0.6);
  Rod(mesh, at, {0.0, 0.0, height}, {0.0, 0.0, height + 0.5}, 0.08);
  mesh.AddEllipsoid(at * Upright({0.0, 0.0, height + 0.5}), {0.08, 0.08, 0.08}, 0.0, 1);
  Rod(mesh, at, {0.08, 0.0, height + 0.1}, {0.05, 0.0, height + 0.6}, 0.015);
}

std::vector<Prop> WallFurniture() {
  return {{AddDesk, 0.8},  {AddShelf, 0.55},      {AddShelf, 0.55},    {AddCabinet, 0.47},
          {AddPlant, 0.4}, {AddCartonStack, 0.3}, {AddCoatStand, 0.35}};
}

std::vector<Prop> LooseFurniture() {
  return {{AddTable, 0.97}, {AddDesk, 0.8},   {AddChair, 0.35},
          {AddChair, 0.35}, {AddChair, 0.35}, {AddBin, 0.2},
          {AddCarton, 0.3}, {AddPlant, 0.4},  {AddCartonStack, 0.3}};
}

std::vector<Prop> CorridorFurniture() {
  return {{AddExtinguisher, 0.15}, {AddBin, 0.17},   {AddCarton, 0.25},
          {AddCabinet, 0.44},      {AddPlant, 0.36}, {AddCoatStand, 0.3}};
}

}  // namespace hv::sim
