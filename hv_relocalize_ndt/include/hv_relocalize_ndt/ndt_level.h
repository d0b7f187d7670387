#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <tsl/robin_map.h>

#include <Eigen/Core>
#include "hv_core/cube_key.h"

namespace hv::relocalize {

/// A voxel as a Gaussian (paper Eq. 21).
struct NdtVoxel {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();         ///< [m]
  Eigen::Matrix3f information = Eigen::Matrix3f::Zero();  ///< inverse covariance [1/m^2]
  /// The same without what only the borders of the voxel tell: planes, and slivers of them in
  /// the next cube, hold across themselves alone, and a spread as wide as the voxel holds nothing
  /// [1/m^2]. Small negative values balance the errors of normals.
  Eigen::Matrix3f held = Eigen::Matrix3f::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();  ///< of the thinnest direction
  /// The normal away from a parallel plane close by: of one face of a wall or slab whose other face
  /// is known as well. Zero where nothing says which side the plane is seen from.
  Eigen::Vector3f facing = Eigen::Vector3f::Zero();
  float thickness_m = 0.0F;  ///< standard deviation across, before small eigenvalues are raised
  float flatness = 1.0F;     ///< smallest variance as a share of the middle one
  std::uint32_t points = 0;

  bool planar() const { return flatness < 0.1F; }
};

/// A cloud as Gaussians, one for each cube that holds enough points, two where these lie on two
/// parallel planes: one Gaussian for both faces of a wall or slab would draw scans into it.
/// Immutable; const methods may run concurrently.
class NdtLevel {
 public:
  /// Voxels around a place: of seven cubes.
  struct Neighbors {
    std::array<std::uint32_t, 14> voxels{};
    std::uint32_t count = 0;
  };

  /// `points` [m]; at least five of them make a voxel (paper 3.4).
  NdtLevel(double resolution_m, const std::vector<Eigen::Vector3f>& points);
  /// From voxels that were made before.
  NdtLevel(double resolution_m, std::vector<NdtVoxel> voxels);

  double resolution_m() const { return resolution_m_; }
  const std::vector<NdtVoxel>& voxels() const { return voxels_; }

  /// The voxels of the cube of `point` and the six cubes beside it; nullptr where there are none.
  const Neighbors* Around(const Eigen::Vector3f& point) const;

 private:
  void Index();
  void FindFaces();
  void FindSlivers();

  double resolution_m_;
  float inverse_size_;
  std::vector<NdtVoxel> voxels_;
  std::vector<Neighbors> neighbors_;
  tsl::robin_map<std::uint64_t, std::uint32_t, CubeHash> cubes_;  ///< with a voxel beside
};

}  // namespace hv::relocalize
