#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <tsl/robin_map.h>
#include <Eigen/Core>

namespace hv::relocalize {

/// A voxel as a Gaussian (paper Eq. 21).
struct NdtVoxel {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();         ///< [m]
  Eigen::Matrix3f information = Eigen::Matrix3f::Zero();  ///< inverse covariance [1/m^2]
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();      ///< of the thinnest direction
  float thickness_m = 0.0F;  ///< standard deviation across, before small eigenvalues are raised
  float flatness = 1.0F;     ///< smallest variance as a share of the middle one
  std::uint32_t points = 0;

  bool planar() const { return flatness < 0.1F; }
};

/// A cloud as Gaussians, one for each cube that holds enough points. Immutable; const methods may
/// run concurrently.
class NdtLevel {
 public:
  /// Voxels around a place: at most seven.
  struct Neighbors {
    std::array<std::uint32_t, 7> voxels{};
    std::uint32_t count = 0;
  };

  /// `points` [m]; at least five of them make a voxel.
  NdtLevel(double resolution_m, const std::vector<Eigen::Vector3f>& points);
  /// From voxels that were made before.
  NdtLevel(double resolution_m, std::vector<NdtVoxel> voxels);

  double resolution_m() const { return resolution_m_; }
  const std::vector<NdtVoxel>& voxels() const { return voxels_; }

  /// The voxels of the cube of `point` and the six cubes beside it; nullptr where there are none.
  const Neighbors* Around(const Eigen::Vector3f& point) const;
  /// The voxel of the cube of `point`; nullptr where there is none.
  const NdtVoxel* At(const Eigen::Vector3f& point) const;

 private:
  void Index();

  double resolution_m_;
  float inverse_size_;
  std::vector<NdtVoxel> voxels_;
  std::vector<Neighbors> neighbors_;
  tsl::robin_map<std::uint64_t, std::uint32_t> cubes_;  ///< of every cube beside a voxel
  tsl::robin_map<std::uint64_t, std::uint32_t> own_;    ///< of every voxel
};

}  // namespace hv::relocalize
