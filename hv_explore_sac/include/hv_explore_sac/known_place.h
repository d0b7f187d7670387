#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "hv_core/occupancy_grid.h"
#include "hv_explore_sac/bounds.h"
#include "hv_explore_sac/exploration_model.h"
#include "hv_navigation/clearance_grid.h"

namespace hv::explore {

/// Cells that keep their coordinates while a map grows.
struct CellFrame {
  double cell_m = 0.1;
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< lower left corner of cell (0, 0) [m]

  /// Far outside for a position that is nowhere.
  Eigen::Vector2i CellOf(const Eigen::Vector2d& position) const {
    constexpr double kFarthest = 1e8;
    const Eigen::Array2d cell = ((position - origin) / cell_m).array().floor();
    return cell.max(-kFarthest).min(kFarthest).cast<int>();
  }
  Eigen::Vector2d CenterOf(const Eigen::Vector2i& cell) const {
    return origin + cell_m * (cell.cast<double>() + Eigen::Vector2d::Constant(0.5));
  }
};

/// The room that a robot needs.
struct RobotSize {
  double drive_m = 0.0;  ///< to obstacles on its way: the largest circle in its footprint
  double turn_m = 0.0;   ///< where it turns: the smallest circle around its footprint
};

/// What a map means to a robot.
struct PlaceRules {
  double room_m = 0.0;  ///< nearer to obstacles than that is closed
  Bounds bounds;        ///< what lies outside is closed
  /// Where the robot has been, one after the other: what is free between them is ground, however
  /// near obstacles are.
  std::vector<Eigen::Vector2i> driven = {};
};

/// The model of a map, with its beliefs filled in and nothing else: what is known, and the ground
/// where the robot may stand. Cells are those of `frame`, which the map's must match but for a
/// shift.
ExplorationModel ModelOf(const navigation::ClearanceGrid& map, const CellFrame& frame,
                         const PlaceRules& rules, const ExplorationConfig& config);

/// The free cell nearest to a position, at most `reach_m` away.
std::optional<Eigen::Vector2i> NearestFree(const Belief& belief, const CellFrame& frame,
                                           const Eigen::Vector2d& position, double reach_m);

/// Cells of the map that are known to be free, inside of the bounds [m^2].
double FreeArea(const OccupancyGrid& map, const Bounds& bounds);

}  // namespace hv::explore
