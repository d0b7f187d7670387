#include "hv_navigation/moving_obstacles.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <opencv2/imgproc.hpp>

namespace hv::navigation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

/// Cells of another grid with the same cells.
class Shifted {
 public:
  Shifted(const OccupancyGrid& grid, const OccupancyGrid& other)
      : other_(other),
        offset_(((grid.origin - other.origin) / grid.resolution_m)
                    .array()
                    .round()
                    .cast<int>()
                    .matrix()) {}

  std::int8_t At(const Vector2i& cell) const {
    const Vector2i there = cell + offset_;
    return other_.Contains(there) ? other_.At(there.x(), there.y()) : OccupancyGrid::kUnknown;
  }

 private:
  const OccupancyGrid& other_;
  Vector2i offset_;
};

}  // namespace

/// Cells newly taken that lie together.
struct MovingObstacles::Group {
  std::vector<Vector2i> cells;
  Vector2d center = Vector2d::Zero();  ///< [m]
};

void MovingObstaclesConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("predict", predict, "keep out of the way of what moves");
  visitor.Field("compare_s", compare_s, "time between the grids that are compared [s]");
  visitor.Field("reach_m", reach_m, "distance from the robot up to which it is looked for [m]");
  visitor.Field("hold_s", hold_s, "what moved is minded when it is not noticed for so long [s]");
  visitor.Field("least_cells", least_cells, "cells newly taken together; fewer are noise");
  visitor.Field("most_cells", most_cells, "cells newly taken together; more are no person");
  visitor.Section("walk", walk, "how it goes on");
}

void MovingObstaclesConfig::Validate(ConfigProblems& problems) const {
  const auto positive = [&](double value, const char* key) {
    problems.Require(value > 0.0, std::string("moving.") + key, "must be positive");
  };
  positive(compare_s, "compare_s");
  positive(reach_m, "reach_m");
  problems.Require(hold_s >= 0.0, "moving.hold_s", "must not be negative");
  problems.Require(least_cells >= 1, "moving.least_cells", "must be at least 1");
  problems.Require(most_cells >= least_cells, "moving.most_cells",
                   "must be at least moving.least_cells");
  walk.Validate(problems);
}

const std::vector<Walker>& MovingObstacles::Track(Time stamp, const OccupancyGrid& seen,
                                                  const Vector2d& robot) {
  if (!config_.predict) return walkers_;
  if (!past_.empty() && (stamp <= past_.back().stamp || stamp - past_.back().stamp > 1.0)) Clear();
  std::vector<Walker> noticed;
  if (const OccupancyGrid* before = GridBefore(stamp)) {
    for (const Group& group : NewlyTaken(seen, *before, robot)) {
      const Vector2d direction = DirectionOf(group, seen, *before);
      if (direction.squaredNorm() > 0.0) noticed.push_back({stamp, group.center, direction});
    }
  }
  Forget(stamp, noticed);
  walkers_.insert(walkers_.end(), noticed.begin(), noticed.end());
  past_.push_back({stamp, seen});
  return walkers_;
}

/// Those who were not noticed for long, and those who have been noticed anew.
void MovingObstacles::Forget(Time now, const std::vector<Walker>& noticed) {
  const double same_m = 2.0 * config_.walk.radius_m;
  const auto is_old = [&](const Walker& walker) {
    return now - walker.stamp > config_.hold_s ||
           std::any_of(noticed.begin(), noticed.end(), [&](const Walker& other) {
             return Walkers::MayBeNear(config_.walk, walker, other.place, same_m, now);
           });
  };
  walkers_.erase(std::remove_if(walkers_.begin(), walkers_.end(), is_old), walkers_.end());
}

/// The newest one that is old enough.
const OccupancyGrid* MovingObstacles::GridBefore(Time stamp) {
  constexpr double kJitter_s = 0.02;
  const auto old_enough = [&](const Past& past) {
    return stamp - past.stamp > config_.compare_s - kJitter_s;
  };
  while (past_.size() > 1 && old_enough(past_[1])) past_.pop_front();
  return !past_.empty() && old_enough(past_.front()) ? &past_.front().grid : nullptr;
}

std::vector<MovingObstacles::Group> MovingObstacles::NewlyTaken(const OccupancyGrid& seen,
                                                                const OccupancyGrid& before,
                                                                const Vector2d& robot) const {
  const Shifted past(seen, before);
  const Vector2i middle = seen.CellOf(robot);
  const int reach = static_cast<int>(config_.reach_m / seen.resolution_m);
  const int side = 2 * reach + 1;
  cv::Mat taken = cv::Mat::zeros(side, side, CV_8U);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const Vector2i cell = middle + Vector2i(x - reach, y - reach);
      if (!seen.Contains(cell) || !OccupancyGrid::IsOccupied(seen.At(cell.x(), cell.y()))) continue;
      if (past.At(cell) == OccupancyGrid::kFree) taken.at<std::uint8_t>(y, x) = 1;
    }
  }
  cv::Mat labels;
  std::vector<Group> groups(static_cast<std::size_t>(cv::connectedComponents(taken, labels, 8)));
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const int label = labels.at<int>(y, x);
      if (label == 0) continue;
      const Vector2i cell = middle + Vector2i(x - reach, y - reach);
      groups[static_cast<std::size_t>(label)].cells.push_back(cell);
      groups[static_cast<std::size_t>(label)].center += seen.CenterOf(cell);
    }
  }
  std::vector<Group> kept;
  for (Group& group : groups) {
    const int size = static_cast<int>(group.cells.size());
    if (size < config_.least_cells || size > config_.most_cells) continue;
    group.center /= size;
    kept.push_back(std::move(group));
  }
  return kept;
}

/// From what it has left; where that cannot be seen, as behind who comes nearer, from where it was.
/// Zero for what has only come into view.
Vector2d MovingObstacles::DirectionOf(const Group& group, const OccupancyGrid& seen,
                                      const OccupancyGrid& before) const {
  constexpr int kLeastCells = 2;
  const double around_m = 2.0 * config_.walk.radius_m + config_.walk.most_mps * config_.compare_s;
  const Shifted past(seen, before);
  const Vector2i middle = seen.CellOf(group.center);
  const int reach = static_cast<int>(around_m / seen.resolution_m);
  Vector2d left = Vector2d::Zero();
  Vector2d was = Vector2d::Zero();
  int left_cells = 0;
  int was_cells = 0;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      const Vector2i cell = middle + Vector2i(x, y);
      if (!seen.Contains(cell) || !OccupancyGrid::IsOccupied(past.At(cell))) continue;
      const Vector2d away = seen.CenterOf(cell) - group.center;
      if (away.norm() > around_m) continue;
      was += away;
      ++was_cells;
      if (seen.At(cell.x(), cell.y()) != OccupancyGrid::kFree) continue;
      left += away;
      ++left_cells;
    }
  }
  if (left_cells >= kLeastCells) return -left.normalized();
  return was_cells >= kLeastCells ? Vector2d(-was.normalized()) : Vector2d::Zero();
}

}  // namespace hv::navigation
