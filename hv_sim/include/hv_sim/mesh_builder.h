#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "hv_core/se3.h"
#include "hv_sim/random.h"
#include "hv_sim/world.h"

namespace hv::sim {

/// Smooth noise in [-1, 1] with features about one unit apart.
double SmoothNoise(const Eigen::Vector3d& point, std::uint32_t seed);

/// Pose of something upright at `position` [m], turned by `yaw` [rad].
Pose Upright(const Eigen::Vector3d& position, double yaw = 0.0);

/// Collects shapes as triangles. Lengths in [m], coordinates of the world unless a pose is given.
class MeshBuilder {
 public:
  /// Reflectivity, in [0, 1], of everything added from now on.
  void SetReflectivity(double reflectivity);

  void AddTriangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

  /// The surface over the unit square as rows x columns quads.
  void AddPatch(int rows, int columns,
                const std::function<Eigen::Vector3d(double, double)>& surface);

  /// Parallelogram at `corner` with sides `u` and `v`, in cells of about `cell`.
  void AddQuad(const Eigen::Vector3d& corner, const Eigen::Vector3d& u, const Eigen::Vector3d& v,
               double cell = 0.5);

  /// Box centred on `T_world_box`.
  void AddBox(const Pose& T_world_box, const Eigen::Vector3d& size, double cell = 0.5);

  /// Box between two opposite corners in the frame of `T_world_frame`.
  void AddBox(const Pose& T_world_frame, const Eigen::Vector3d& low, const Eigen::Vector3d& high);

  /// Truncated cone with caps; a cylinder when the radii are equal.
  void AddFrustum(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double from_radius,
                  double to_radius, int sides = 12);
  void AddCylinder(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius,
                   int sides = 12);

  /// Ellipsoid whose surface is rough by up to `roughness` times its radius.
  void AddEllipsoid(const Pose& T_world_body, const Eigen::Vector3d& radii, double roughness,
                    std::uint32_t seed);

  /// Cylinders through `points`.
  void AddTube(const std::vector<Eigen::Vector3d>& points, double radius, int sides = 8);

  /// A cable hanging between two points with `sag` at its middle.
  void AddCable(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double sag, double radius);

  /// `count` triangles of about `leaf` at random in an ellipsoid, denser at its hull.
  void AddLeaves(const Eigen::Vector3d& center, const Eigen::Vector3d& radii, int count,
                 double leaf, Random& random);

  /// Moves every vertex added so far by smooth noise of up to `amplitude`, so that nothing is
  /// exactly flat.
  void Undulate(double amplitude, double wavelength, std::uint32_t seed);

  /// Makes everything added so far at most this reflective.
  void LimitReflectivity(double limit);

  const Mesh& mesh() const { return mesh_; }

 private:
  std::uint32_t AddVertex(const Eigen::Vector3d& point);
  void AddFace(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  Mesh mesh_;
  float reflectivity_ = 0.5F;
};

}  // namespace hv::sim
