#pragma once

#include <Eigen/Core>
#include <vector>

#include "hv_sim/mesh_builder.h"
#include "hv_sim/random.h"

namespace hv::sim {

/// An upright shape standing at a pose (x is its front) inside a disc of `radius` [m].
struct Prop {
  void (*add)(MeshBuilder& mesh, const Pose& at, Random& random) = nullptr;
  double radius = 0.5;
};

/// Axis-aligned floor area at height `z` [m].
struct Area {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Zero();
  double z = 0.0;
};

/// A world under construction: its triangles, its dice, and the floor that is still free. Props
/// stay out of the way of the route and of each other.
class Site {
 public:
  Site(const std::vector<Eigen::Vector3d>& route, bool closed, std::uint32_t seed);

  /// Places a prop when its disc is free; tells whether it was.
  bool Place(const Prop& prop, const Eigen::Vector3d& at, double yaw);

  /// Tries `count` times to place one of `props` at random in `area`.
  void Scatter(const std::vector<Prop>& props, const Area& area, int count);

  /// Places props side by side from `from` to `to`, fronts to the left; a tenth is left out.
  void LineUp(const std::vector<Prop>& props, const Eigen::Vector3d& from,
              const Eigen::Vector3d& to);

  /// Keeps later props out of a disc.
  void Reserve(const Eigen::Vector3d& at, double radius);

  MeshBuilder mesh;
  Random random;

 private:
  struct Disc {
    Eigen::Vector3d at;
    double radius;
  };

  bool IsFree(const Disc& disc) const;

  std::vector<Eigen::Vector3d> route_;
  std::vector<Disc> taken_;
};

}  // namespace hv::sim
