#pragma once

#include <cmath>
#include <memory>

#include "grids.h"
#include "hv_navigation/navigator.h"
#include "kinematic_robot.h"

namespace hv::navigation {

/// A robot in a world with a map of it, a rolling window of what it sees, and a navigator.
class SimulatedSite {
 public:
  static constexpr double kPeriod_s = 0.1;

  SimulatedSite(const OccupancyGrid& map, const PlanarPose& start, const PlanningConfig& config,
                PlanningWorker::Mode mode = PlanningWorker::Mode::kAtOnce)
      : world(map),
        navigator(config, mode),
        robot(start, config.limits),
        footprint_(Bare(config.footprint)) {
    SetMap(map);
  }

  void SetMap(const OccupancyGrid& map) {
    input.map = std::make_shared<const ClearanceGrid>(map, ClearanceGrid::Unknown::kOccupied, 1.5);
  }

  const NavigationOutput& Step() {
    time_s += kPeriod_s;
    input.now = Time::FromSeconds(1000.0 + time_s);
    input.T_map_base = robot.pose();
    input.T_local_base = T_local_map * robot.pose();
    input.velocity = MeasuredVelocity();
    last_velocity_ = robot.velocity();
    if (sees) {
      input.pose_stamp = input.obstacles_stamp = input.now;
      input.local_grid = LocalGrid();
    }
    output = navigator.Update(input);
    if (output.look_again) ghosts.clear();
    robot.Drive(output.velocity, kPeriod_s);
    const ClearanceGrid truth(world, ClearanceGrid::Unknown::kOccupied, 1.0);
    collided |= footprint_.Collides(truth, robot.pose());
    return output;
  }

  /// Until the goal has ended, or the time is over.
  std::optional<NavigationResult> Run(double longest_s) {
    const double end_s = time_s + longest_s;
    do {
      Step();
    } while (!output.result && time_s < end_s);
    return output.result;
  }

  OccupancyGrid world;  ///< in the frame of the map
  Navigator navigator;
  KinematicRobot robot;
  PlanarPose T_local_map;
  std::vector<Eigen::Vector2d> ghosts;  ///< seen until cleared, in the map
  NavigationInput input;
  NavigationOutput output;
  bool sees = true;  ///< whether sensors and pose come in
  bool collided = false;
  double velocity_lag = 0.0;  ///< share of the last cycle's change that is not measured yet
  double time_s = 0.0;

 private:
  Velocity MeasuredVelocity() const {
    const Velocity& now = robot.velocity();
    const auto lagging = [&](double from, double to) { return to + velocity_lag * (from - to); };
    return {lagging(last_velocity_.linear_mps, now.linear_mps),
            lagging(last_velocity_.angular_rps, now.angular_rps)};
  }

  /// 10 x 10 m around the robot, as seen from the local frame.
  std::shared_ptr<const ClearanceGrid> LocalGrid() const {
    constexpr double kHalf_m = 5.0;
    constexpr double kCell_m = 0.05;
    OccupancyGrid cells = EmptyCells(static_cast<int>(2.0 * kHalf_m / kCell_m),
                                     static_cast<int>(2.0 * kHalf_m / kCell_m), kCell_m);
    const Eigen::Vector2d corner = input.T_local_base.position - Eigen::Vector2d(kHalf_m, kHalf_m);
    cells.origin = kCell_m * (corner / kCell_m).array().floor().matrix();
    const PlanarPose T_map_local = T_local_map.Inverse();
    for (int row = 0; row < cells.height; ++row) {
      for (int column = 0; column < cells.width; ++column) {
        const Eigen::Vector2d center =
            cells.origin + kCell_m * Eigen::Vector2d(column + 0.5, row + 0.5);
        const Eigen::Vector2i at = ((T_map_local * center - world.origin) / world.resolution_m)
                                       .array()
                                       .floor()
                                       .cast<int>();
        const bool inside =
            at.x() >= 0 && at.y() >= 0 && at.x() < world.width && at.y() < world.height;
        cells.At(column, row) = inside ? world.At(at.x(), at.y()) : OccupancyGrid::kUnknown;
      }
    }
    for (const Eigen::Vector2d& ghost : ghosts) {
      const Eigen::Vector2d center = T_local_map * ghost;
      FillCells(cells, center.array() - 0.1, center.array() + 0.1);
    }
    return std::make_shared<const ClearanceGrid>(std::move(cells), ClearanceGrid::Unknown::kFree,
                                                 1.5);
  }

  Footprint footprint_;
  Velocity last_velocity_;
};

}  // namespace hv::navigation
