#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "hv_core/occupancy_grid.h"
#include "hv_navigation/clearance_grid.h"
#include "hv_navigation/mapping_config.h"
#include "hv_navigation/planar.h"

namespace hv::navigation {

/// The grid that routes are planned in, in the frame of the map: a saved map, if there is one,
/// corrected by what is seen. It grows where the robot gets beyond.
///
/// An obstacle is added once `mark_views` views in a row show it, and taken away after
/// `clear_views` views in a row that show free space. What the saved map holds is taken away only
/// where it is movable, that is small and apart from everything else, and only by views from near.
/// Walls, and what stands against them, stay whatever is seen through them: an error of
/// localisation of a few centimetres must not open a wall. Nor must it make one thicker: what is
/// seen in a cell next to an obstacle of the saved map is that obstacle.
///
/// Deterministic. Not thread-safe.
class GlobalGrid {
 public:
  explicit GlobalGrid(const GlobalGridConfig& config,
                      std::optional<OccupancyGrid> saved = std::nullopt);

  /// Takes a view: obstacles in the frame of odometry, and the robot there. Views whose pose is not
  /// finite, and cells beyond the largest grid, are left out.
  void Update(const OccupancyGrid& observed, const PlanarPose& T_map_odom,
              const Eigen::Vector2d& robot_in_odom);

  /// Forgets what was seen, for when the pose in the map was wrong.
  void ForgetViews();
  /// Whether there are obstacles that a saved map does not hold; never without a saved map.
  bool has_additions() const { return additions_ > 0; }
  /// Forgets them: those that are still there will be seen again.
  void ForgetAdditions();

  const OccupancyGrid& grid() const { return grid_; }

  /// What has changed in the grid since this was last asked.
  struct Changes {
    bool everything = false;  ///< it began, grew or forgot; else
    std::optional<CellBox> cells;
  };
  Changes TakeChanges() { return std::exchange(changes_, Changes()); }

  std::size_t left_out() const { return left_out_; }  ///< cells beyond the largest grid

 private:
  void FindMovable();
  std::pair<int, int> GrowthAlong(int axis, double low_m, double high_m) const;
  void GrowToHold(const Eigen::Vector2d& low, const Eigen::Vector2d& high);
  OccupancyGrid Turned(const OccupancyGrid& observed, const PlanarPose& T_map_odom) const;
  bool IsAddition(std::size_t index) const;
  void SetCell(const Eigen::Vector2i& at, std::int8_t value);
  void TakeCell(const Eigen::Vector2i& at, bool occupied, bool near);

  GlobalGridConfig config_;
  OccupancyGrid grid_;
  std::vector<std::int8_t> saved_;    ///< of the saved map; unknown elsewhere
  std::vector<std::uint8_t> fixed_;   ///< 1: an obstacle of the saved map that stays
  std::vector<std::uint8_t> beside_;  ///< 1: next to an obstacle of the saved map
  std::vector<std::int8_t> run_;      ///< views in a row with an obstacle, negative: without
  bool has_saved_ = false;
  std::size_t additions_ = 0;  ///< cells
  Changes changes_;
  std::size_t left_out_ = 0;
};

}  // namespace hv::navigation
