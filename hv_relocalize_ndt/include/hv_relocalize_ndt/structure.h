#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "hv_core/se3.h"
#include "hv_relocalize_ndt/ndt_level.h"

namespace hv::relocalize {

/// Kinds of structure that a cube can hold, as bits: six for walls by the direction of their
/// normal, modulo half a turn, in steps of 30 deg; one for what is no plane, one for floors and
/// ceilings. Slanted planes count as no plane.
using StructureBits = std::uint8_t;
inline constexpr int kWallDirections = 6;
inline constexpr StructureBits kClutter = 1U << 6U;
inline constexpr StructureBits kLevel = 1U << 7U;

/// Structure that a scan sees in one cube, in a frame whose z axis is vertical.
struct StructureCell {
  Eigen::Vector3f center = Eigen::Vector3f::Zero();  ///< mean of the points [m]
  float azimuth = 0.0F;  ///< of the normal of a wall [rad]; of no meaning else
  bool wall = false;
  bool level = false;  ///< neither: clutter

  /// What a cube of the map must hold to fit the cell, turned by `yaw` [rad].
  StructureBits Fits(float yaw) const;
};

/// The cells of a cloud's voxels in a frame that `R_level_cloud` turns upright.
std::vector<StructureCell> StructureCells(const NdtLevel& cloud,
                                          const Eigen::Matrix3d& R_level_cloud);

/// The direction against gravity in the frame of a cloud, from its planes: floors, ceilings and
/// walls lie across and along it. `guess`: that direction to 30 deg. Without planes, the guess.
Eigen::Vector3d EstimateUp(const NdtLevel& cloud, const Eigen::Vector3d& guess);

/// The least rotation that turns `up` to the z axis.
Eigen::Matrix3d UprightRotation(const Eigen::Vector3d& up);

/// Which structure a map holds where, as a dense grid of bits, and the same for windows of 2, 4, 8
/// ... cubes: what a window does not hold, no cube of it does, so that whole regions of poses are
/// refused at once. Immutable.
class StructureGrid {
 public:
  /// `surfaces`: voxels of the map, whose edge becomes that of the cubes; `depth`: levels of
  /// windows, the coarsest of 2^(depth-1) cubes. Throws InputError when the map is so large and
  /// sparse that the grid would not fit into memory.
  StructureGrid(const NdtLevel& surfaces, int depth);

  double cell_m() const { return cell_m_; }
  int depth() const { return static_cast<int>(levels_.size()); }
  /// Cube of a point; may lie outside of the map.
  Eigen::Vector3i CellOf(const Eigen::Vector3d& point) const;
  /// Number of cubes along each axis; those of the map start at zero.
  const Eigen::Vector3i& size() const { return size_; }
  /// The corner of cube zero [m].
  const Eigen::Vector3d& origin() const { return origin_; }

  /// What the cubes [cell, cell + 2^level) hold.
  StructureBits At(int level, const Eigen::Vector3i& cell) const {
    return Value(levels_[static_cast<std::size_t>(level)], cell);
  }

  /// Whether a sensor can be in one of the cubes [cell, cell + 2^level): there is a floor below.
  bool CanStand(int level, const Eigen::Vector3i& cell) const {
    return Value(standing_[static_cast<std::size_t>(level)], cell) != 0;
  }

 private:
  std::size_t Index(const Eigen::Vector3i& padded) const {
    return (static_cast<std::size_t>(padded.z()) * static_cast<std::size_t>(padded_size_.y()) +
            static_cast<std::size_t>(padded.y())) *
               static_cast<std::size_t>(padded_size_.x()) +
           static_cast<std::size_t>(padded.x());
  }
  StructureBits Value(const std::vector<StructureBits>& grid, const Eigen::Vector3i& cell) const {
    const Eigen::Vector3i padded = cell + Eigen::Vector3i::Constant(padding_);
    if ((padded.array() < 0).any() || (padded.array() >= padded_size_.array()).any()) return 0;
    return grid[Index(padded)];
  }
  void SetSize(const NdtLevel& surfaces);
  std::vector<StructureBits> PlacesToStand() const;
  std::vector<std::vector<StructureBits>> Windows(std::vector<StructureBits> finest,
                                                  int depth) const;
  void Widen(int step, std::vector<StructureBits>& grid) const;

  double cell_m_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  int padding_ = 0;  ///< cubes before the map on each axis, for windows that reach into it
  Eigen::Vector3i padded_size_ = Eigen::Vector3i::Zero();
  std::vector<std::vector<StructureBits>> levels_;
  std::vector<std::vector<StructureBits>> standing_;
};

}  // namespace hv::relocalize
