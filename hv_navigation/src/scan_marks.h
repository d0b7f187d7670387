#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace hv::navigation {

/// What one scan says about the voxels of a box: where returns lie, and at which heights rays
/// passed. Lengths are in voxels. Dense, so that drawing a ray costs a few operations a voxel;
/// blocks of voxels lie together in the order of an octree, so that an octree takes them over
/// branch by branch.
class ScanMarks {
 public:
  static constexpr int kBlockSide = 8;
  static constexpr int kBlockVoxels = kBlockSide * kBlockSide * kBlockSide;
  static constexpr int kSlices = 8;

  /// Bit k of the first eight: a ray passed through slice k of the voxel, from below.
  using Mark = std::uint16_t;
  static constexpr Mark kPassed = 0xFF;
  static constexpr Mark kHit = 0x100;
  static constexpr Mark kRayEnd = 0x200;

  /// Returns in one voxel.
  struct Hit {
    std::uint32_t voxel = 0;
    float low = 0.0F;   ///< z of the lowest, in voxels
    float high = 0.0F;  ///< z of the highest
  };

  /// Sets the box, in blocks, and forgets the scan.
  void SetBox(const Eigen::Vector3i& low_block, const Eigen::Vector3i& blocks);
  /// Forgets the scan.
  void Restart();

  const Eigen::Vector3i& low_block() const { return low_block_; }
  const Eigen::Vector3i& blocks() const { return blocks_; }
  bool Contains(const Eigen::Vector3d& point) const;

  /// `point` must lie inside.
  void AddHit(const Eigen::Vector3d& point);
  /// Marks what lies between `from` and the voxel of `to`; the part outside of the box is left out.
  /// `from` must lie inside. Of rays that end in the same voxel only the first is drawn.
  void AddRay(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

  /// Sorts the returns; call it before looking at the marks.
  void Finish();

  std::size_t block_count() const { return touched_.size(); }
  bool Touched(std::size_t block) const { return touched_[block] != 0; }
  Eigen::Vector3i BlockAt(std::size_t block) const;
  /// Marks of the block, child by child of each octant.
  const Mark* MarksOf(std::size_t block) const { return &marks_[block * kBlockVoxels]; }
  /// Of a voxel with kHit, given its place among all marks.
  const Hit& HitAt(std::size_t voxel) const;
  /// The voxel at a place among all marks.
  Eigen::Vector3i CellAt(std::size_t index) const;
  std::size_t IndexOf(const Mark* mark) const {
    return static_cast<std::size_t>(mark - marks_.data());
  }

 private:
  std::size_t Index(const Eigen::Vector3i& cell) const;

  Eigen::Vector3i low_block_ = Eigen::Vector3i::Zero();
  Eigen::Vector3i blocks_ = Eigen::Vector3i::Zero();
  Eigen::Vector3i low_cell_ = Eigen::Vector3i::Zero();
  std::vector<Mark> marks_;
  std::vector<std::uint8_t> touched_;  ///< per block
  std::vector<Hit> hits_;
};

}  // namespace hv::navigation
