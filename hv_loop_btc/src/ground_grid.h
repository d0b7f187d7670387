#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "hv_core/occupancy_grid.h"
#include "hv_loop_btc/map_builder.h"
#include "voxel_space.h"

namespace hv::loop {

/// Height of the ground over the area that rays passed, followed outwards from under the first
/// sensor position, and from under those that stand on ground which cannot be followed to. Where
/// floors lie above each other it is the one that connects to the start. Cells are voxels seen from
/// above, or several of them where the map is so large that there would be more than `kMaxCells`.
class GroundGrid {
 public:
  static constexpr std::size_t kMaxCells = std::size_t{1} << 26U;

  GroundGrid(const VoxelSpace& space, const std::vector<Eigen::Vector3d>& sensor_positions);

  /// Ground under or over a position [m]; NaN where it is not known.
  float HeightAt(const Eigen::Vector3d& position) const;

  /// Occupied, free and unknown cells; surfaces that are moving do not count.
  OccupancyGrid MakeGrid(const MapBuilderConfig& config) const;

 private:
  struct Seed {
    Eigen::Vector2i cell;
    float height;
  };

  void ChooseFrame();
  void SortColumns();
  std::vector<Seed> FindSeeds(const std::vector<Eigen::Vector3d>& sensor_positions) const;
  float GroundNear(const Eigen::Vector3d& sensor) const;
  std::vector<Seed> ElsewhereSeeds(const std::vector<Seed>& seeds) const;
  void Grow(const std::vector<Seed>& seeds);
  void GrowAgain(const std::vector<Seed>& seeds);
  void Visit(const Eigen::Vector2i& cell, float from_neighbours);
  float MeanAround(const Eigen::Vector2i& cell, float neighbour) const;
  void MarkFree(const Block& block, const MapBuilderConfig& config, OccupancyGrid& grid) const;

  Eigen::Vector2i CellOf(int voxel_x, int voxel_y) const;
  bool Contains(const Eigen::Vector2i& cell) const;
  std::size_t Index(const Eigen::Vector2i& cell) const {
    return static_cast<std::size_t>(cell.y()) * static_cast<std::size_t>(size_.x()) +
           static_cast<std::size_t>(cell.x());
  }

  const VoxelSpace& space_;
  int voxels_per_cell_ = 1;
  Eigen::Vector2i low_ = Eigen::Vector2i::Zero();   ///< first cell, in cells from the map's origin
  Eigen::Vector2i size_ = Eigen::Vector2i::Zero();  ///< in cells
  std::vector<std::uint32_t> column_begin_;         ///< per cell, into column_heights_
  std::vector<float> column_heights_;               ///< of surfaces [m], each column ascending
  std::vector<float> ground_;                       ///< per cell [m], NaN: not known
  std::vector<bool> measured_;                      ///< per cell: a surface lies at that height
};

}  // namespace hv::loop
