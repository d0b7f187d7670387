#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace hv::sim {

/// Static triangles of a world, z up, [m]. `reflectivity` in [0, 1] per triangle drives intensity
/// and maximum range.
struct Mesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<float> reflectivity;
};

/// A closed polyline on the floor that a person walks along for ever at `speed`.
struct PersonPath {
  std::vector<Eigen::Vector3d> waypoints;  ///< feet [m]
  double speed = 1.2;                      ///< [m/s]
  double phase = 0.0;                      ///< starting arc length [m]
};

/// Geometry to look at and a way through it. `route` is a polyline on the floor (z is the floor's
/// height). Between 0.7 and 1.5 m above it, it keeps at least 0.6 m (0.15 m in narrow floor plans)
/// from everything static, its corners sharp or rounded with a radius of up to 1 m. When `closed`,
/// the last waypoint leads back to the first.
struct World {
  std::string name;
  Mesh mesh;
  std::vector<Eigen::Vector3d> route;
  bool closed = true;
  std::vector<PersonPath> people;
};

/// Names accepted by MakeWorld, for help texts.
std::vector<std::string> WorldNames();

/// Builds a world: one of WorldNames(), or the path of a map_server YAML whose floor plan is
/// extruded. `seed` places clutter. Throws InputError for an unknown name or a bad floor plan.
World MakeWorld(const std::string& name, std::uint32_t seed);

}  // namespace hv::sim
