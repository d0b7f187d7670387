#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "hv_navigation/obstacle_map.h"

namespace hv::navigation {

/// The columns of voxels of an obstacle map in a square: in each the occupied surfaces from below,
/// and what is known to be free. Heights reach from a fifth of 64 voxels below the middle to the
/// rest above. Immutable; const methods may run concurrently.
class SurfaceColumns {
 public:
  /// Heights of the returns of one occupied voxel [m].
  struct Surface {
    float low = 0.0F;
    float high = 0.0F;
  };
  struct Column {
    const Surface* first;
    const Surface* last;  ///< behind the last one
    const Surface* begin() const { return first; }
    const Surface* end() const { return last; }
  };

  /// `middle` [m] must be finite, and is in the middle column.
  SurfaceColumns(const ObstacleMap& map, const Eigen::Vector3d& middle, double side_m);

  int side() const { return side_; }  ///< columns along x, and along y
  double voxel_m() const { return voxel_m_; }
  Eigen::Vector2d origin() const { return low_.head<2>().cast<double>() * voxel_m_; }
  bool Contains(const Eigen::Vector2i& cell) const {
    return (cell.array() >= 0).all() && (cell.array() < side_).all();
  }
  std::size_t Index(const Eigen::Vector2i& cell) const {
    return static_cast<std::size_t>(cell.y()) * static_cast<std::size_t>(side_) +
           static_cast<std::size_t>(cell.x());
  }

  Column At(std::size_t index) const {
    return {surfaces_.data() + begin_[index], surfaces_.data() + begin_[index + 1]};
  }
  /// Whether a free voxel has its middle between two heights [m].
  bool FreeBetween(std::size_t index, double low_m, double high_m) const;
  /// Whether a free voxel lies all below a height [m].
  bool FreeBelow(std::size_t index, double height_m) const {
    return FreeBetween(index, -1e9, height_m - 0.5 * voxel_m_);
  }

 private:
  struct Placed {
    std::size_t column;
    Surface surface;
  };

  void AddFree(const VoxelView& voxel);
  void AddOccupied(const VoxelView& voxel, std::vector<Placed>& placed) const;
  void Sort(const std::vector<Placed>& placed);

  double voxel_m_;
  int side_;
  Eigen::Vector3i low_;  ///< voxel at the bottom of column (0, 0)
  std::vector<std::uint64_t> free_;
  std::vector<std::uint32_t> begin_;
  std::vector<Surface> surfaces_;
};

}  // namespace hv::navigation
