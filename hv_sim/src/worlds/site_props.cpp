#include "site_props.h"

#include <algorithm>
#include <cmath>

#include "furniture.h"

namespace hv::sim {
namespace {

using Eigen::Vector3d;

std::uint32_t Key(Random& random) { return static_cast<std::uint32_t>(random.Bits()); }

/// A heap of loose material: rough, half in the ground, with stones on and around it.
void AddHeap(MeshBuilder& mesh, const Pose& at, double radius, double height, Random& random) {
  mesh.SetReflectivity(random.Uniform(0.2, 0.45));
  const Pose tilted =
      at * MakePose(RotationFromRpy(random.Uniform(-0.1, 0.1), random.Uniform(-0.1, 0.1), 0.0),
                    Vector3d::Zero());
  mesh.AddEllipsoid(tilted, {0.8 * radius, 0.65 * radius, height}, 0.25, Key(random));
  for (int i = 0; i < 12; ++i) {
    const double turn = random.Uniform(-M_PI, M_PI);
    const double out = radius * random.Uniform(0.5, 0.92);
    const double size = random.Uniform(0.04, 0.08) * std::min(1.5, radius);
    mesh.AddEllipsoid(at * Upright({out * std::cos(turn), out * std::sin(turn), 0.4 * size}, turn),
                      {size, 0.7 * size, 0.6 * size}, 0.3, Key(random));
  }
}

}  // namespace

void AddMound(MeshBuilder& mesh, const Pose& at, Random& random) {
  AddHeap(mesh, at, 0.8, random.Uniform(0.3, 0.6), random);
}

void AddBigMound(MeshBuilder& mesh, const Pose& at, Random& random) {
  AddHeap(mesh, at, 2.4, random.Uniform(0.9, 1.7), random);
}

void AddBrickPallet(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(0.35);
  for (const double y : {-0.35, 0.0, 0.35}) {
    mesh.AddBox(at, Vector3d(-0.5, y - 0.05, 0.0), Vector3d(0.5, y + 0.05, 0.12));
  }
  mesh.SetReflectivity(0.3);
  const int rows = 1 + static_cast<int>(random.Bits() % 4);
  for (int row = 0; row < rows; ++row) {
    for (int brick = 0; brick < 4; ++brick) {
      if (row + 1 == rows && random.Chance(0.4)) continue;
      const Pose one = at * Upright({-0.36 + 0.24 * brick + random.Uniform(-0.02, 0.02),
                                     random.Uniform(-0.04, 0.04), 0.12 + 0.22 * row + 0.11},
                                    random.Uniform(-0.06, 0.06));
      mesh.AddBox(one, Vector3d(0.22, 0.75, 0.2));
    }
  }
}

void AddPipeStack(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(0.5);
  const double radius = random.Uniform(0.05, 0.12);
  for (int row = 0; row < 3; ++row) {
    for (int i = 0; i < 5 - row; ++i) {
      const double y = radius * (2.05 * i + row - 4.0);
      const double z = radius * (1.0 + 1.73 * row);
      const double shift = random.Uniform(-0.2, 0.2);
      mesh.AddCylinder(at * Vector3d(shift - 0.9, y, z), at * Vector3d(shift + 0.9, y, z), radius,
                       10);
    }
  }
}

void AddCableDrum(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(0.45);
  const double radius = random.Uniform(0.35, 0.6);
  const Vector3d left(0.0, -0.3, radius);
  const Vector3d right(0.0, 0.3, radius);
  mesh.AddCylinder(at * left, at * Vector3d(0.0, -0.25, radius), radius, 20);
  mesh.AddCylinder(at * right, at * Vector3d(0.0, 0.25, radius), radius, 20);
  mesh.SetReflectivity(0.1);
  mesh.AddCylinder(at * left, at * right, 0.6 * radius, 16);
}

void AddBarrel(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(random.Uniform(0.15, 0.6));
  mesh.AddCylinder(at.translation(), at * Vector3d(0.0, 0.0, 0.88), 0.29, 16);
  for (const double z : {0.29, 0.58}) {
    mesh.AddCylinder(at * Vector3d(0.0, 0.0, z), at * Vector3d(0.0, 0.0, z + 0.03), 0.305, 16);
  }
}

void AddTrafficCone(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(0.8);
  mesh.AddBox(at, Vector3d(-0.18, -0.18, 0.0), Vector3d(0.18, 0.18, 0.03));
  mesh.AddFrustum(at * Vector3d(0.0, 0.0, 0.03), at * Vector3d(0.0, 0.0, random.Uniform(0.5, 0.7)),
                  0.14, 0.03);
}

void AddTrestle(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(0.45);
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.3, 0.3}) {
      mesh.AddCylinder(at * Vector3d(x, y, 0.0), at * Vector3d(x, 0.2 * y, 0.85), 0.03, 6);
    }
  }
  const Pose top = at * Upright({0.0, 0.0, 0.87}, random.Uniform(-0.2, 0.2));
  mesh.AddBox(top, Vector3d(1.4, 0.25, 0.04));
}

void AddPlankPile(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(0.5);
  const int count = 4 + static_cast<int>(random.Bits() % 6);
  for (int i = 0; i < count; ++i) {
    const Pose plank =
        at *
        MakePose(RotationFromRpy(random.Uniform(-0.06, 0.06), random.Uniform(-0.04, 0.04),
                                 random.Uniform(-0.25, 0.25)),
                 Vector3d(random.Uniform(-0.1, 0.1), random.Uniform(-0.2, 0.2), 0.04 + 0.05 * i));
    mesh.AddBox(plank, Vector3d(1.6, 0.18, 0.04));
  }
}

void AddLadder(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(0.6);
  const double lean = random.Uniform(0.5, 0.7);
  const auto rail = [&](double y, double s) -> Vector3d {
    return at * Vector3d(-lean + 2.0 * lean * s, y, 2.6 * s);
  };
  for (const double y : {-0.2, 0.2}) mesh.AddCylinder(rail(y, 0.0), rail(y, 1.0), 0.03, 6);
  for (int rung = 1; rung < 9; ++rung) {
    mesh.AddCylinder(rail(-0.2, rung / 9.0), rail(0.2, rung / 9.0), 0.018, 6);
  }
  mesh.AddCylinder(at * Vector3d(0.9 * lean, 0.0, 0.0), rail(0.0, 0.9), 0.03, 6);
}

void AddContainer(MeshBuilder& mesh, const Pose& at, Random& /*random*/) {
  mesh.SetReflectivity(0.4);
  mesh.AddBox(at, Vector3d(-3.0, -1.2, 0.15), Vector3d(3.0, 1.2, 2.6));
  for (int rib = 0; rib < 24; ++rib) {
    const double x = -2.9 + 0.25 * rib;
    mesh.AddBox(at, Vector3d(x, -1.24, 0.25), Vector3d(x + 0.12, 1.24, 2.5));
  }
}

void AddMixer(MeshBuilder& mesh, const Pose& at, Random& random) {
  mesh.SetReflectivity(0.45);
  const Pose drum =
      at * MakePose(RotationFromRpy(0.0, random.Uniform(0.3, 0.8), 0.0), Vector3d(0.0, 0.0, 0.95));
  mesh.AddEllipsoid(drum, {0.4, 0.4, 0.5}, 0.03, Key(random));
  for (const double x : {-0.45, 0.45}) {
    for (const double y : {-0.35, 0.35}) {
      mesh.AddCylinder(at * Vector3d(x, y, 0.0), at * Vector3d(0.4 * x, y, 0.9), 0.03, 6);
    }
  }
  mesh.AddCylinder(at * Vector3d(0.45, -0.4, 0.2), at * Vector3d(0.45, -0.3, 0.2), 0.2, 14);
  mesh.AddCylinder(at * Vector3d(0.45, 0.3, 0.2), at * Vector3d(0.45, 0.4, 0.2), 0.2, 14);
}

void AddScaffold(MeshBuilder& mesh, const Pose& at, double length, int levels) {
  constexpr double kBay = 2.0;
  constexpr double kLift = 2.0;
  const double top = kLift * levels + 1.0;
  const auto tube = [&](const Vector3d& from, const Vector3d& to) {
    mesh.AddCylinder(at * from, at * to, 0.025, 6);
  };
  mesh.SetReflectivity(0.55);
  for (double x = 0.0; x <= length; x += kBay) {
    for (const double y : {0.0, 1.0}) tube({x, y, 0.0}, {x, y, top});
    for (int level = 1; level <= levels; ++level) {
      tube({x, 0.0, kLift * level}, {x, 1.0, kLift * level});
    }
    if (x + kBay <= length) tube({x, 0.0, 0.1}, {x + kBay, 0.0, kLift});
  }
  for (int level = 1; level <= levels; ++level) {
    const double z = kLift * level;
    for (const double rail : {0.5, 1.0}) tube({0.0, 0.0, z + rail}, {length, 0.0, z + rail});
    for (const double y : {0.05, 0.38, 0.71}) {
      mesh.AddBox(at, Vector3d(0.0, y, z), Vector3d(length, y + 0.27, z + 0.045));
    }
  }
}

void AddRailing(MeshBuilder& mesh, const std::vector<Vector3d>& points) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Vector3d span = points[i] - points[i - 1];
    const int posts = std::max(1, static_cast<int>(span.norm() / 2.0));
    for (int post = 0; post <= posts; ++post) {
      const Vector3d foot = points[i - 1] + span * post / posts;
      mesh.AddCylinder(foot, foot + 1.1 * Vector3d::UnitZ(), 0.03, 6);
    }
    for (const double height : {0.15, 0.6, 1.08}) {
      const Vector3d up = height * Vector3d::UnitZ();
      mesh.AddCylinder(points[i - 1] + up, points[i] + up, 0.02, 6);
    }
  }
}

std::vector<Prop> SiteProps() {
  return {{AddMound, 0.85},      {AddBrickPallet, 0.68}, {AddPipeStack, 1.2}, {AddCableDrum, 0.7},
          {AddBarrel, 0.35},     {AddTrafficCone, 0.3},  {AddTrestle, 0.85},  {AddPlankPile, 1.1},
          {AddCartonStack, 0.3}, {AddLadder, 0.85},      {AddMixer, 0.75},    {AddBarrel, 0.35}};
}

}  // namespace hv::sim
