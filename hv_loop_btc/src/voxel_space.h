#pragma once

#include <bitset>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

#include "hv_core/scan.h"

namespace hv::loop {

/// Index of a cube of the map along each axis.
using VoxelIndex = Eigen::Vector3i;

/// 21 bits an axis, for indices in +-2^20.
inline std::uint64_t KeyOf(const VoxelIndex& index) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    key = (key << 21U) | static_cast<std::uint64_t>(index[axis] + (1 << 20));
  }
  return key;
}

/// A return in the map frame.
struct MapPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  float intensity = 0.0F;
};

/// A voxel that was hit, and the evidence for and against something being there.
struct Surface {
  VoxelIndex voxel = VoxelIndex::Zero();
  Eigen::Vector3f offset_sum = Eigen::Vector3f::Zero();  ///< from the lower corner [m]
  float intensity_sum = 0.0F;
  float points = 0.0F;
  std::uint16_t hits = 0;    ///< scans with a return from it
  std::uint16_t misses = 0;  ///< scans that saw through its points instead
  std::uint32_t hit_scan = 0;
  std::uint32_t miss_scan = 0;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< unit; 0 where it is not flat
  bool moving = false;
};

/// Which voxels of a cube of kSide^3 were hit or seen through.
struct Block {
  static constexpr int kBits = 4;
  static constexpr int kSide = 1 << kBits;
  static constexpr std::size_t kVoxels = std::size_t{1} << (3 * kBits);

  VoxelIndex index = VoxelIndex::Zero();  ///< in blocks
  std::bitset<kVoxels> hit;
  std::bitset<kVoxels> free;

  /// Bit of the voxel with these remainders, each in [0, kSide).
  static std::size_t Bit(int x, int y, int z) {
    return static_cast<std::size_t>((((z << kBits) | y) << kBits) | x);
  }
};

/// Sparse voxels of the whole map. Hits of all scans come first, then their rays. Points further
/// than 2^20 voxels from the origin are ignored. Not synchronised.
class VoxelSpace {
 public:
  VoxelSpace(double voxel_m, double max_ray_m) : voxel_m_(voxel_m), max_ray_m_(max_ray_m) {}

  void AddHits(std::uint32_t scan, const std::vector<MapPoint>& points);

  /// Finds flat surroundings. To be called between hits and rays.
  void FindNormals();

  /// Marks what the rays of one scan passed as free, up to the largest ray length, and counts
  /// misses. Scans are numbered from 1, as in AddHits.
  void CastRays(std::uint32_t scan, const Eigen::Vector3d& origin,
                const std::vector<MapPoint>& points);

  double voxel_m() const { return voxel_m_; }
  std::vector<Surface>& surfaces() { return surfaces_; }
  const std::vector<Surface>& surfaces() const { return surfaces_; }
  /// In order of first use.
  const std::vector<std::unique_ptr<Block>>& blocks() const { return blocks_; }

  /// Mean of the points of a surface [m].
  Eigen::Vector3d MeanOf(const Surface& surface) const;
  /// Null when there is none.
  Surface* Find(const VoxelIndex& voxel);
  bool IndexOf(const Eigen::Vector3d& position, VoxelIndex& voxel) const;

 private:
  struct Ray;
  Block& BlockOf(const VoxelIndex& voxel);
  void CastRay(const Ray& ray, const VoxelIndex& last);
  void Pass(const Ray& ray, const VoxelIndex& voxel);
  bool SeesThrough(const Ray& ray, const Surface& surface) const;
  Eigen::Vector3f NormalAt(const Surface& surface);

  const double voxel_m_;
  const double max_ray_m_;
  std::vector<Surface> surfaces_;
  std::unordered_map<std::uint64_t, std::uint32_t> surface_of_voxel_;
  std::vector<std::unique_ptr<Block>> blocks_;
  std::unordered_map<std::uint64_t, std::uint32_t> block_of_index_;
  Block* last_block_ = nullptr;
};

/// Calls visit(voxel) for every voxel that the segment from `from` to `to` passes, the one of
/// `from` included, in order, until visit returns false (Amanatides and Woo 1987).
template <typename Visit>
void WalkVoxels(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double voxel_m,
                const Visit& visit) {
  const Eigen::Vector3d start = from / voxel_m;
  const Eigen::Vector3d step = to / voxel_m - start;
  VoxelIndex voxel = start.array().floor().cast<int>();
  Eigen::Vector3i direction;
  Eigen::Vector3d next;   // share of the segment at the next boundary of each axis
  Eigen::Vector3d delta;  // share of the segment between boundaries
  for (int axis = 0; axis < 3; ++axis) {
    direction[axis] = step[axis] >= 0.0 ? 1 : -1;
    const double boundary = voxel[axis] + (direction[axis] > 0 ? 1.0 : 0.0);
    const bool parallel = std::abs(step[axis]) < 1e-12;
    next[axis] = parallel ? 2.0 : (boundary - start[axis]) / step[axis];
    delta[axis] = parallel ? 2.0 : 1.0 / std::abs(step[axis]);
  }
  for (;;) {
    if (!visit(voxel)) return;
    const int first = next[0] < next[1] ? 0 : 1;
    const int axis = next[first] < next[2] ? first : 2;
    if (!(next[axis] <= 1.0)) return;
    voxel[axis] += direction[axis];
    next[axis] += delta[axis];
  }
}

}  // namespace hv::loop
