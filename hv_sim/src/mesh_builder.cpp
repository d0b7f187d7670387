#include "hv_sim/mesh_builder.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hv::sim {
namespace {

using Eigen::Vector3d;

double LatticeValue(std::int64_t x, std::int64_t y, std::int64_t z, std::uint32_t seed) {
  const auto key = [](std::int64_t value) { return static_cast<std::uint64_t>(value); };
  return Random({seed, key(x), key(y), key(z)}).Uniform(-1.0, 1.0);
}

double Smooth(double s) { return s * s * (3.0 - 2.0 * s); }

/// Two unit vectors that are normal to `axis` and to each other.
std::array<Vector3d, 2> Perpendiculars(const Vector3d& axis) {
  const Vector3d first = axis.unitOrthogonal();
  return {first, axis.normalized().cross(first)};
}

}  // namespace

double SmoothNoise(const Vector3d& point, std::uint32_t seed) {
  const Vector3d base = point.array().floor();
  const Vector3d fraction = point - base;
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1.0;
    std::array<std::int64_t, 3> index{};
    for (int axis = 0; axis < 3; ++axis) {
      const bool upper = ((corner >> axis) & 1) != 0;
      const double share = Smooth(fraction[axis]);
      weight *= upper ? share : 1.0 - share;
      index[static_cast<std::size_t>(axis)] =
          static_cast<std::int64_t>(base[axis]) + (upper ? 1 : 0);
    }
    sum += weight * LatticeValue(index[0], index[1], index[2], seed);
  }
  return sum;
}

Pose Upright(const Vector3d& position, double yaw) {
  return MakePose(RotationFromRpy(0.0, 0.0, yaw), position);
}

void MeshBuilder::SetReflectivity(double reflectivity) {
  reflectivity_ = static_cast<float>(reflectivity);
}

std::uint32_t MeshBuilder::AddVertex(const Vector3d& point) {
  mesh_.vertices.push_back(point.cast<float>());
  return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
}

void MeshBuilder::AddFace(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  // The poles of patches give triangles without area, of no use to distance queries.
  constexpr float kLeastArea = 1e-8F;  // [m^2]
  const Eigen::Vector3f u = mesh_.vertices[b] - mesh_.vertices[a];
  const Eigen::Vector3f v = mesh_.vertices[c] - mesh_.vertices[a];
  if (u.cross(v).norm() < kLeastArea) return;
  mesh_.triangles.push_back({a, b, c});
  mesh_.reflectivity.push_back(reflectivity_);
}

void MeshBuilder::AddTriangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const std::uint32_t first = AddVertex(a);
  AddVertex(b);
  AddVertex(c);
  AddFace(first, first + 1, first + 2);
}

void MeshBuilder::AddPatch(int rows, int columns,
                           const std::function<Vector3d(double, double)>& surface) {
  const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
  const auto width = static_cast<std::uint32_t>(columns + 1);
  for (int i = 0; i <= rows; ++i) {
    for (int j = 0; j <= columns; ++j) {
      AddVertex(surface(static_cast<double>(i) / rows, static_cast<double>(j) / columns));
    }
  }
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(rows); ++i) {
    for (std::uint32_t j = 0; j + 1 < width; ++j) {
      const std::uint32_t a = first + i * width + j;
      AddFace(a, a + 1, a + width);
      AddFace(a + 1, a + width + 1, a + width);
    }
  }
}

void MeshBuilder::AddQuad(const Vector3d& corner, const Vector3d& u, const Vector3d& v,
                          double cell) {
  const auto cells = [cell](double length) {
    return std::max(1, static_cast<int>(std::lround(length / cell)));
  };
  AddPatch(cells(u.norm()), cells(v.norm()),
           [&](double s, double t) -> Vector3d { return corner + s * u + t * v; });
}

void MeshBuilder::AddBox(const Pose& T_world_box, const Vector3d& size, double cell) {
  const Eigen::Matrix3d axes = T_world_box.linear() * size.asDiagonal();
  const Vector3d low = T_world_box.translation() - 0.5 * axes.rowwise().sum();
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d u = axes.col((axis + 1) % 3);
    const Vector3d v = axes.col((axis + 2) % 3);
    AddQuad(low, u, v, cell);
    AddQuad(low + axes.col(axis), u, v, cell);
  }
}

void MeshBuilder::AddBox(const Pose& T_world_frame, const Vector3d& low, const Vector3d& high) {
  const Pose T_frame_box(Eigen::Translation3d(0.5 * (low + high)));
  AddBox(T_world_frame * T_frame_box, Vector3d(high - low));
}

void MeshBuilder::AddFrustum(const Vector3d& from, const Vector3d& to, double from_radius,
                             double to_radius, int sides) {
  const auto [u, v] = Perpendiculars(to - from);
  const auto ring = [u = u, v = v](double turn) -> Vector3d {
    return std::cos(2.0 * M_PI * turn) * u + std::sin(2.0 * M_PI * turn) * v;
  };
  AddPatch(1, sides, [&](double s, double t) -> Vector3d {
    return from + s * (to - from) + (from_radius + s * (to_radius - from_radius)) * ring(t);
  });
  AddPatch(1, sides,
           [&](double s, double t) -> Vector3d { return from + s * from_radius * ring(t); });
  AddPatch(1, sides, [&](double s, double t) -> Vector3d { return to + s * to_radius * ring(t); });
}

void MeshBuilder::AddCylinder(const Vector3d& from, const Vector3d& to, double radius, int sides) {
  AddFrustum(from, to, radius, radius, sides);
}

void MeshBuilder::AddEllipsoid(const Pose& T_world_body, const Vector3d& radii, double roughness,
                               std::uint32_t seed) {
  AddPatch(10, 16, [&](double s, double t) -> Vector3d {
    const double polar = M_PI * s;
    const double turn = t < 1.0 ? 2.0 * M_PI * t : 0.0;
    const Vector3d unit(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn),
                        std::cos(polar));
    const double scale = 1.0 + roughness * SmoothNoise(2.5 * unit, seed);
    return T_world_body * Vector3d(scale * radii.cwiseProduct(unit));
  });
}

void MeshBuilder::AddTube(const std::vector<Vector3d>& points, double radius, int sides) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    AddCylinder(points[i - 1], points[i], radius, sides);
  }
}

void MeshBuilder::AddCable(const Vector3d& from, const Vector3d& to, double sag, double radius) {
  constexpr int kPieces = 10;
  std::vector<Vector3d> points;
  for (int i = 0; i <= kPieces; ++i) {
    const double s = static_cast<double>(i) / kPieces;
    points.emplace_back(from + s * (to - from) - 4.0 * sag * s * (1.0 - s) * Vector3d::UnitZ());
  }
  AddTube(points, radius, 6);
}

void MeshBuilder::AddLeaves(const Vector3d& center, const Vector3d& radii, int count, double leaf,
                            Random& random) {
  const auto direction = [&random]() -> Vector3d {
    return Vector3d(random.Gauss(), random.Gauss(), random.Gauss()).normalized();
  };
  for (int i = 0; i < count; ++i) {
    const double depth = std::sqrt(random.Uniform(0.15, 1.0));
    const Vector3d at = center + depth * radii.cwiseProduct(direction());
    const double size = leaf * random.Uniform(0.6, 1.4);
    AddTriangle(at, at + size * direction(), at + size * direction());
  }
}

void MeshBuilder::Undulate(double amplitude, double wavelength, std::uint32_t seed) {
  for (Eigen::Vector3f& vertex : mesh_.vertices) {
    const Vector3d at = vertex.cast<double>() / wavelength;
    const Vector3d shift(SmoothNoise(at, seed), SmoothNoise(at, seed + 1),
                         SmoothNoise(at, seed + 2));
    vertex += (amplitude * shift).cast<float>();
  }
}

void MeshBuilder::LimitReflectivity(double limit) {
  for (float& value : mesh_.reflectivity) value = std::min(value, static_cast<float>(limit));
}

}  // namespace hv::sim
