#include "building.h"

#include <algorithm>
#include <cmath>

namespace hv::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Adds boxes given along, across and above the wall's base line.
class WallFrame {
 public:
  WallFrame(MeshBuilder& mesh, const Wall& wall)
      : mesh_(mesh), half_(0.5 * wall.thickness), height_(wall.height) {
    const Vector2d along = wall.to - wall.from;
    length_ = along.norm();
    T_world_wall_ = Upright(Vector3d(wall.from.x(), wall.from.y(), wall.base),
                            std::atan2(along.y(), along.x()));
  }

  double length() const { return length_; }

  /// A box from `from` to `to` along the wall that stands out of both faces by `proud`.
  void Piece(double from, double to, double bottom, double top, double proud) {
    if (to - from < 1e-6 || top - bottom < 1e-6) return;
    const double depth = half_ + proud;
    mesh_.AddBox(T_world_wall_, Vector3d(from, -depth, bottom), Vector3d(to, depth, top));
  }

  void Solid(double from, double to) { Piece(from, to, 0.0, height_, 0.0); }

  void Hole(const Opening& hole) {
    Piece(hole.from, hole.to, 0.0, hole.bottom, 0.0);
    Piece(hole.from, hole.to, hole.top, height_, 0.0);
    constexpr double kFrame = 0.06;
    constexpr double kProud = 0.03;
    Piece(hole.from, hole.from + kFrame, hole.bottom, hole.top, kProud);
    Piece(hole.to - kFrame, hole.to, hole.bottom, hole.top, kProud);
    Piece(hole.from, hole.to, hole.top - kFrame, hole.top, kProud);
    if (hole.bottom > 0.0) {
      Piece(hole.from - kFrame, hole.to + kFrame, hole.bottom - 0.04, hole.bottom, 0.09);
    }
  }

 private:
  MeshBuilder& mesh_;
  Pose T_world_wall_;
  double length_ = 0.0;
  double half_;
  double height_;
};

}  // namespace

void AddWall(MeshBuilder& mesh, const Wall& wall) {
  WallFrame frame(mesh, wall);
  double done = 0.0;
  for (const Opening& hole : wall.openings) {
    frame.Solid(done, hole.from);
    frame.Hole(hole);
    done = hole.to;
  }
  frame.Solid(done, frame.length());
}

void AddFloor(MeshBuilder& mesh, const Area& area) {
  const Vector2d size = area.high - area.low;
  mesh.AddQuad({area.low.x(), area.low.y(), area.z}, {size.x(), 0.0, 0.0}, {0.0, size.y(), 0.0});
}

void AddDoorLeaf(MeshBuilder& mesh, const Vector3d& hinge, double yaw, double width) {
  const Pose T_world_hinge = Upright(hinge, yaw);
  mesh.AddBox(T_world_hinge, Vector3d(0.0, -0.02, 0.01), Vector3d(width, 0.02, 2.03));
  mesh.AddCylinder(T_world_hinge * Vector3d(width - 0.08, -0.07, 1.05),
                   T_world_hinge * Vector3d(width - 0.08, 0.07, 1.05), 0.02, 6);
}

std::vector<Opening> Windows(double length, double first, double pitch, double width, double bottom,
                             double top) {
  std::vector<Opening> windows;
  for (double from = first; from + width < length - 0.3; from += pitch) {
    windows.push_back({from, from + width, bottom, top});
  }
  return windows;
}

void AddServices(MeshBuilder& mesh, const Vector3d& from, const Vector3d& to, Random& random) {
  const Vector3d along = (to - from).normalized();
  const Vector3d side = along.cross(Vector3d::UnitZ());
  const double length = (to - from).norm();
  mesh.AddCylinder(from, to, 0.08, 10);
  mesh.AddCylinder(from + 0.22 * side, to + 0.22 * side, 0.035, 8);
  for (double done = random.Uniform(0.5, 1.5); done < length; done += random.Uniform(1.5, 3.5)) {
    const Vector3d at = from + done * along;
    mesh.AddCylinder(at, at + 0.3 * Vector3d::UnitZ(), 0.012, 5);
    mesh.AddFrustum(at - 0.05 * along, at + 0.05 * along, 0.11, 0.11, 10);
    if (random.Chance(0.4)) {
      mesh.AddCable(at - 0.2 * side, at + random.Uniform(0.8, 2.0) * along - 0.25 * side,
                    random.Uniform(0.03, 0.12), 0.012);
    }
  }
}

}  // namespace hv::sim
