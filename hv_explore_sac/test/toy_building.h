#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hv_explore_sac/explorer.h"
#include "hv_navigation/grid_search.h"

namespace hv::explore {

constexpr double kRobotRadius_m = 0.28;
constexpr RobotSize kRobotSize{kRobotRadius_m, 0.4};

/// A grid of 0.1 m from a drawing in tiles of 0.5 m: `#` is a wall, all else is free. The first row
/// is the northernmost.
inline OccupancyGrid Drawn(const std::vector<std::string>& rows,
                           const Eigen::Vector2d& origin = Eigen::Vector2d::Zero()) {
  constexpr int kTile = 5;
  OccupancyGrid grid;
  grid.resolution_m = 0.1;
  grid.origin = origin;
  grid.width = kTile * static_cast<int>(rows.front().size());
  grid.height = kTile * static_cast<int>(rows.size());
  for (int y = 0; y < grid.height; ++y) {
    const std::string& row = rows[rows.size() - 1 - static_cast<std::size_t>(y / kTile)];
    for (int x = 0; x < grid.width; ++x) {
      const bool wall = row[static_cast<std::size_t>(x / kTile)] == '#';
      grid.cells.push_back(wall ? OccupancyGrid::kOccupied : OccupancyGrid::kFree);
    }
  }
  return grid;
}

/// Two rooms beside a corridor, 12 x 10 m.
inline OccupancyGrid TwoRooms() {
  return Drawn({
      "########################",
      "#.........##...........#",
      "#.........##...........#",
      "#.........##...........#",
      "#.........##...........#",
      "#.........##...........#",
      "#.........##...........#",
      "#.........##...........#",
      "#.........##...........#",
      "#.........##...........#",
      "#.........##...........#",
      "####..###########..#####",
      "#......................#",
      "#......................#",
      "#......................#",
      "########################",
  });
}

/// A robot in a true grid: what it has seen is a grid that grows with it, in steps of 4 m to every
/// side.
class ToyRobot {
 public:
  ToyRobot(OccupancyGrid truth, const Eigen::Vector2d& start)
      : truth_(std::move(truth)),
        clearance_(truth_, navigation::ClearanceGrid::Unknown::kOccupied, 1.0) {
    pose_.position = start;
    known_.resolution_m = truth_.resolution_m;
    known_.origin =
        truth_.origin + known_.resolution_m * truth_.CellOf(start).cast<double>().eval();
    Sense();
  }

  const navigation::PlanarPose& pose() const { return pose_; }
  const OccupancyGrid& known() const { return known_; }
  std::shared_ptr<const OccupancyGrid> SharedMap() const {
    return std::make_shared<OccupancyGrid>(known_);
  }

  /// Whether the robot can get there.
  bool CanReach(const Eigen::Vector2d& goal) { return !WayTo(goal).empty(); }

  /// Drives at most so far along the shortest way; returns whether it is there.
  bool DriveTowards(const Eigen::Vector2d& goal, double distance_m) {
    const std::vector<Eigen::Vector2i> way = WayTo(goal);
    if (way.empty()) return false;
    const auto steps = static_cast<std::size_t>(std::lround(distance_m / truth_.resolution_m));
    const Eigen::Vector2d before = pose_.position;
    pose_.position = truth_.CenterOf(way[std::min(steps, way.size() - 1)]);
    const Eigen::Vector2d moved = pose_.position - before;
    if (moved.norm() > 0.0) pose_.yaw = std::atan2(moved.y(), moved.x());
    Sense();
    return way.size() <= steps + 1;
  }

  /// Sees what lies within 6 m.
  void Sense() {
    constexpr double kRange_m = 6.0;
    Grow(pose_.position - Eigen::Vector2d::Constant(kRange_m));
    Grow(pose_.position + Eigen::Vector2d::Constant(kRange_m));
    for (int ray = 0; ray < 720; ++ray) {
      const double angle = 2.0 * M_PI * ray / 720.0;
      const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
      for (double range = 0.0; range < kRange_m; range += 0.05) {
        if (!See(pose_.position + range * direction)) break;
      }
    }
  }

 private:
  std::vector<Eigen::Vector2i> WayTo(const Eigen::Vector2d& goal) {
    const auto factor = [this](const Eigen::Vector2i& cell) {
      return clearance_.ClearanceAt(cell) >= kRobotRadius_m ? 1.0 : 0.0;
    };
    navigation::GridSearch search(clearance_);
    const Eigen::Vector2i to = truth_.CellOf(goal);
    if (!truth_.Contains(to) || factor(to) == 0.0) return {};
    if (!search.Run(truth_.CellOf(pose_.position), to, factor)) return {};
    return search.RouteTo(to);
  }

  bool See(const Eigen::Vector2d& position) {
    const Eigen::Vector2i cell = truth_.CellOf(position);
    if (!truth_.Contains(cell)) return false;
    const Eigen::Vector2i at = known_.CellOf(truth_.CenterOf(cell));
    known_.At(at.x(), at.y()) = truth_.At(cell.x(), cell.y());
    return !OccupancyGrid::IsOccupied(truth_.At(cell.x(), cell.y()));
  }

  void Grow(const Eigen::Vector2d& position) {
    constexpr int kStep = 40;
    while (!known_.Contains(known_.CellOf(position))) {
      OccupancyGrid larger = known_;
      larger.origin -= Eigen::Vector2d::Constant(kStep * known_.resolution_m);
      larger.width += 2 * kStep;
      larger.height += 2 * kStep;
      larger.cells.assign(static_cast<std::size_t>(larger.width * larger.height),
                          OccupancyGrid::kUnknown);
      for (int y = 0; y < known_.height; ++y) {
        for (int x = 0; x < known_.width; ++x) larger.At(x + kStep, y + kStep) = known_.At(x, y);
      }
      known_ = std::move(larger);
    }
  }

  OccupancyGrid truth_;
  navigation::ClearanceGrid clearance_;
  OccupancyGrid known_;
  navigation::PlanarPose pose_;
};

}  // namespace hv::explore
