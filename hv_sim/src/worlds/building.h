#pragma once

#include <Eigen/Core>
#include <vector>

#include "hv_sim/mesh_builder.h"
#include "site.h"

namespace hv::sim {

/// A hole in a wall, measured from the wall's start and base [m]. Doors have bottom 0.
struct Opening {
  double from = 0.0;
  double to = 0.0;
  double bottom = 0.0;
  double top = 2.1;
};

struct Wall {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
  std::vector<Opening> openings;  ///< sorted, apart from each other
  double base = 0.0;
  double height = 2.8;
  double thickness = 0.15;
};

/// Wall with frames around its openings and sills under its windows.
void AddWall(MeshBuilder& mesh, const Wall& wall);

/// A horizontal surface.
void AddFloor(MeshBuilder& mesh, const Area& area);

/// A door leaf hinged at `hinge`, turned to `yaw`.
void AddDoorLeaf(MeshBuilder& mesh, const Eigen::Vector3d& hinge, double yaw, double width);

/// Openings of `width` every `pitch` from `first`, as many as fit in `length`.
std::vector<Opening> Windows(double length, double first, double pitch, double width,
                             double bottom = 0.9, double top = 2.2);

/// Pipes and a cable tray with hangers under a ceiling.
void AddServices(MeshBuilder& mesh, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                 Random& random);

}  // namespace hv::sim
