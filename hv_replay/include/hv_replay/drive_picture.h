#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "hv_core/occupancy_grid.h"

namespace hv::replay {

/// A drive seen from above, in the map [m].
struct DrivenLine {
  std::vector<Eigen::Vector2d> points;
  Eigen::Vector2d goal = Eigen::Vector2d::Zero();
  bool failed = false;
  std::vector<Eigen::Vector2d> contacts;  ///< where the robot collided
};

/// Draws drives over the map: goals that were reached in green, failures and what was driven for
/// them in red, collisions as black discs. Throws InputError when the file cannot be written or the
/// map is empty.
void DrawDrives(const OccupancyGrid& map, const std::vector<DrivenLine>& lines,
                const std::string& title, const std::string& path);

/// The way of one drive in the map [m].
struct DrivenWay {
  std::vector<Eigen::Vector2d> points;
  std::vector<Eigen::Vector2d> contacts;  ///< where the robot collided
};

/// Draws a way over the map, from dark at its start to bright at its end, with both ends and
/// collisions. Throws InputError as DrawDrives() does.
void DrawExploration(const OccupancyGrid& map, const DrivenWay& way, const std::string& title,
                     const std::string& path);

}  // namespace hv::replay
