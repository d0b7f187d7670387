#include "hv_navigation/moving_obstacles.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <opencv2/imgproc.hpp>

namespace hv::navigation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

std::int8_t StateAt(const OccupancyGrid& grid, const Vector2d& place) {
  const Vector2i cell = grid.CellOf(place);
  return grid.Contains(cell) ? grid.At(cell.x(), cell.y()) : OccupancyGrid::kUnknown;
}

}  // namespace

void MovingObstaclesConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("predict", predict, "keep out of the way of what moves");
  visitor.Field("compare_s", compare_s, "time between the grids that are compared [s]");
  visitor.Field("flicker_s", flicker_s, "what was taken so shortly before is not taken newly [s]");
  visitor.Field("reach_m", reach_m, "distance from the robot up to which it is looked for [m]");
  visitor.Field("least_cells", least_cells, "cells newly taken together; fewer are noise");
  visitor.Field("appear_cells", appear_cells,
                "cells newly taken together; fewer are not taken for somebody at once");
  visitor.Field("most_cells", most_cells, "cells newly taken together; more are no person");
  visitor.Field("follow_s", follow_s, "for how long cells newly taken are followed [s]");
  visitor.Field("least_sightings", least_sightings,
                "of cells newly taken in a line of motion; fewer are chance");
  visitor.Field("off_line_m", off_line_m, "by which these may lie beside the line [m]");
  visitor.Field("appear_s", appear_s, "what has appeared may be somebody for so long [s]");
  visitor.Field("hold_s", hold_s, "who moved is minded, when not noticed for so long [s]");
  visitor.Field("near_m", near_m, "so near to the robot people may not be seen at all [m]");
  visitor.Field("hold_near_s", hold_near_s, "and are minded for so long [s]");
  visitor.Section("walk", walk, "how it goes on");
}

void MovingObstaclesConfig::Validate(ConfigProblems& problems) const {
  const auto positive = [&](double value, const char* key) {
    problems.Require(value > 0.0, std::string("moving.") + key, "must be positive");
  };
  positive(compare_s, "compare_s");
  positive(reach_m, "reach_m");
  positive(follow_s, "follow_s");
  positive(off_line_m, "off_line_m");
  problems.Require(flicker_s >= 0.0, "moving.flicker_s", "must not be negative");
  problems.Require(appear_cells >= 1, "moving.appear_cells", "must be at least 1");
  problems.Require(appear_s >= 0.0, "moving.appear_s", "must not be negative");
  problems.Require(hold_s >= 0.0, "moving.hold_s", "must not be negative");
  problems.Require(near_m >= 0.0, "moving.near_m", "must not be negative");
  problems.Require(hold_near_s >= hold_s, "moving.hold_near_s", "must be at least moving.hold_s");
  problems.Require(least_cells >= 1, "moving.least_cells", "must be at least 1");
  problems.Require(most_cells >= least_cells, "moving.most_cells",
                   "must be at least moving.least_cells");
  problems.Require(least_sightings >= 2, "moving.least_sightings", "must be at least 2");
  walk.Validate(problems);
}

const std::vector<Walker>& MovingObstacles::Track(Time stamp, const OccupancyGrid& seen,
                                                  const Vector2d& robot) {
  if (!config_.predict) return walkers_;
  if (!past_.empty() && (stamp <= past_.back().stamp || stamp - past_.back().stamp > 1.0)) Clear();
  while (!past_.empty() && stamp - past_.front().stamp > config_.compare_s + config_.flicker_s) {
    past_.pop_front();
  }
  while (!sightings_.empty() && stamp - sightings_.front().stamp > config_.follow_s) {
    sightings_.pop_front();
  }
  std::vector<Walker> noticed;
  std::vector<Sighting> sightings = NewlyTaken(stamp, seen, robot);
  for (Sighting& sighting : sightings) {
    Recognise(sighting);
    std::optional<Walker> walker = Follow(sighting);
    if (!walker) walker = SlowedDown(sighting);
    if (walker) noticed.push_back(*walker);
  }
  Forget(stamp, robot, noticed);
  walkers_.insert(walkers_.end(), noticed.begin(), noticed.end());
  NoteAppeared(stamp, sightings);
  sightings_.insert(sightings_.end(), sightings.begin(), sightings.end());
  past_.push_back({stamp, seen});
  return walkers_;
}

/// Free when it was last compared, and not taken shortly before.
bool MovingObstacles::IsNew(const Vector2d& place, Time stamp) const {
  constexpr double kJitter_s = 0.02;
  bool was_free = false;
  for (const Past& past : past_) {
    if (stamp - past.stamp < config_.compare_s - kJitter_s) break;
    const std::int8_t state = StateAt(past.grid, place);
    if (OccupancyGrid::IsOccupied(state)) return false;
    was_free = state == OccupancyGrid::kFree;
  }
  return was_free;
}

std::vector<MovingObstacles::Sighting> MovingObstacles::NewlyTaken(Time stamp,
                                                                   const OccupancyGrid& seen,
                                                                   const Vector2d& robot) const {
  const int reach = static_cast<int>(config_.reach_m / seen.resolution_m);
  const Vector2i low = seen.CellOf(robot) - Vector2i::Constant(reach);
  const int side = 2 * reach + 1;
  cv::Mat taken = cv::Mat::zeros(side, side, CV_8U);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const Vector2i cell = low + Vector2i(x, y);
      if (!seen.Contains(cell) || !OccupancyGrid::IsOccupied(seen.At(cell.x(), cell.y()))) continue;
      if (IsNew(seen.CenterOf(cell), stamp)) taken.at<std::uint8_t>(y, x) = 1;
    }
  }
  cv::Mat labels;
  cv::Mat statistics;
  cv::Mat centers;
  const int groups = cv::connectedComponentsWithStats(taken, labels, statistics, centers, 8);
  std::vector<Sighting> sightings;
  for (int group = 1; group < groups; ++group) {
    const int size = statistics.at<int>(group, cv::CC_STAT_AREA);
    if (size < config_.least_cells || size > config_.most_cells) continue;
    const Vector2d center(centers.at<double>(group, 0), centers.at<double>(group, 1));
    sightings.push_back({stamp, seen.CenterOf(low) + seen.resolution_m * center, size, false});
  }
  return sightings;
}

/// What is sighted at the same place again has come into view, and stays.
void MovingObstacles::Recognise(Sighting& sighting) {
  constexpr double kLeastTime_s = 0.18;
  const double same_m = config_.walk.least_mps * kLeastTime_s;
  for (Sighting& before : sightings_) {
    if (sighting.stamp - before.stamp < kLeastTime_s) break;
    if ((sighting.place - before.place).norm() > same_m) continue;
    sighting.stays = before.stays = true;
  }
}

/// Whether it is the end of a line of motion: the velocity that most of the sightings agree upon.
std::optional<Walker> MovingObstacles::Follow(const Sighting& sighting) const {
  constexpr double kLeastTime_s = 0.25;
  constexpr double kSlack = 0.3;  // of the speeds
  std::optional<Walker> walker;
  if (sighting.stays) return walker;
  int most = config_.least_sightings - 2;
  for (const Sighting& before : sightings_) {
    const double time_s = sighting.stamp - before.stamp;
    if (time_s < kLeastTime_s) break;
    if (before.stays) continue;
    const Vector2d velocity = (sighting.place - before.place) / time_s;
    const double speed_mps = velocity.norm();
    if (speed_mps < (1.0 - kSlack) * config_.walk.least_mps ||
        speed_mps > (1.0 + kSlack) * config_.walk.most_mps) {
      continue;
    }
    const int count = CountInLine(sighting, velocity);
    if (count <= most) continue;
    most = count;
    walker = Walker{sighting.stamp, sighting.place, velocity / speed_mps};
  }
  return walker;
}

/// Whether it is somebody noticed before who gets on less than a walk: a person about to stop.
std::optional<Walker> MovingObstacles::SlowedDown(const Sighting& sighting) const {
  if (!sighting.stays) return {};
  WalkConfig slowed = config_.walk;
  slowed.least_mps = 0.0;
  for (const Walker& walker : walkers_) {
    if (Walkers::MayBeNear(slowed, walker, sighting.place, slowed.radius_m, sighting.stamp)) {
      return Walker{sighting.stamp, sighting.place, walker.direction};
    }
  }
  return {};
}

/// Times at which something was sighted where it would have been.
int MovingObstacles::CountInLine(const Sighting& sighting, const Vector2d& velocity) const {
  int count = 0;
  std::optional<Time> counted;
  for (const Sighting& before : sightings_) {
    if (before.stays || counted == before.stamp) continue;
    const Vector2d place = sighting.place - (sighting.stamp - before.stamp) * velocity;
    if ((place - before.place).norm() > config_.off_line_m) continue;
    ++count;
    counted = before.stamp;
  }
  return count;
}

/// Twice within a moment, so near that somebody may have walked from one place to the other.
bool MovingObstacles::SightedAgain(const Sighting& sighting) const {
  constexpr double kMoment_s = 0.25;
  constexpr double kSlack_m = 0.15;
  return std::any_of(sightings_.begin(), sightings_.end(), [&](const Sighting& before) {
    const double since_s = sighting.stamp - before.stamp;
    return since_s <= kMoment_s &&
           (sighting.place - before.place).norm() <= config_.walk.most_mps * since_s + kSlack_m;
  });
}

/// The newest at each place, where nobody has been noticed.
void MovingObstacles::NoteAppeared(Time now, const std::vector<Sighting>& sightings) {
  const double same_m = 2.0 * config_.walk.radius_m;
  const auto drop = [this](const auto& which) {
    appeared_.erase(std::remove_if(appeared_.begin(), appeared_.end(), which), appeared_.end());
  };
  for (const Sighting& sighting : sightings) {
    if (sighting.stays || sighting.cells < config_.appear_cells) continue;
    if (!SightedAgain(sighting)) continue;
    drop([&](const Walker& one) { return (one.place - sighting.place).norm() <= same_m; });
    appeared_.push_back({now, sighting.place, Vector2d::Zero()});
  }
  drop([&](const Walker& one) {
    return now - one.stamp > config_.appear_s ||
           std::any_of(walkers_.begin(), walkers_.end(), [&](const Walker& walker) {
             return (walker.place - one.place).norm() <= same_m;
           });
  });
}

/// Those who were not noticed for long, and those who have been noticed anew.
void MovingObstacles::Forget(Time now, const Vector2d& robot, const std::vector<Walker>& noticed) {
  const double same_m = 2.0 * config_.walk.radius_m;
  const auto is_old = [&](const Walker& walker) {
    const bool near = Walkers::MayBeNear(config_.walk, walker, robot, config_.near_m, now);
    return now - walker.stamp > (near ? config_.hold_near_s : config_.hold_s) ||
           std::any_of(noticed.begin(), noticed.end(), [&](const Walker& other) {
             return Walkers::MayBeNear(config_.walk, walker, other.place, same_m, now);
           });
  };
  walkers_.erase(std::remove_if(walkers_.begin(), walkers_.end(), is_old), walkers_.end());
}

}  // namespace hv::navigation
