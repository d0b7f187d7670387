#pragma once

#include <random>
#include <vector>

#include <Eigen/Core>

#include "hv_relocalize_ndt/ndt_level.h"

namespace hv::relocalize {

/// Adds points on the parallelogram at `corner` with sides `u` and `v`, with noise of `sigma_m`
/// along its normal.
inline void AddFace(const Eigen::Vector3f& corner, const Eigen::Vector3f& u,
                    const Eigen::Vector3f& v, int count, float sigma_m, std::mt19937& random,
                    std::vector<Eigen::Vector3f>& points) {
  std::uniform_real_distribution<float> share(0.0F, 1.0F);
  std::normal_distribution<float> noise(0.0F, sigma_m);
  const Eigen::Vector3f normal = u.cross(v).normalized();
  for (int i = 0; i < count; ++i) {
    points.push_back(corner + share(random) * u + share(random) * v + noise(random) * normal);
  }
}

/// A plane that fills the cube around `center`, as a voxel.
inline NdtVoxel PlaneVoxel(const Eigen::Vector3f& center, const Eigen::Vector3f& normal) {
  NdtVoxel voxel;
  voxel.mean = center;
  voxel.normal = normal.normalized();
  voxel.thickness_m = 0.02F;
  voxel.flatness = 0.01F;
  voxel.points = 50;
  return voxel;
}

/// Something that is no plane, as a voxel.
inline NdtVoxel ClutterVoxel(const Eigen::Vector3f& center) {
  NdtVoxel voxel = PlaneVoxel(center, Eigen::Vector3f::UnitX());
  voxel.flatness = 0.6F;
  return voxel;
}

}  // namespace hv::relocalize
