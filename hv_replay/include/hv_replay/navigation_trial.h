#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "hv_navigation/planar.h"
#include "hv_replay/json.h"

namespace hv::replay {

/// One goal and the drive to it. Poses are in the map.
struct NavigationTrial {
  int number = 0;
  navigation::PlanarPose start;  ///< the true one
  navigation::PlanarPose goal;
  double optimal_m = 0.0;      ///< see GoalSampler
  bool reached = false;        ///< by its own account, and truly within 0.5 m
  std::string reason;          ///< why not, one line
  navigation::PlanarPose end;  ///< the true one
  double driven_m = 0.0;       ///< truly
  double time_s = 0.0;
  int collisions = 0;     ///< the robot moved
  int hit_by_people = 0;  ///< people walked into the robot, which stood
  int recoveries = 0;
  std::vector<double> plan_ms;
  std::vector<double> control_ms;  ///< a value a cycle, without plans
  std::vector<double> update_ms;   ///< of the obstacle map, a value a scan
  std::vector<double> depth_ms;    ///< the same, a value a depth image
  std::vector<double> grids_ms;    ///< of the 2-D grids, a value a cycle
  std::size_t octree_nodes = 0;    ///< at most
  double worst_place_m = 0.0;      ///< greatest error of its own place

  bool boxed = false;        ///< the scenario has put its box
  double response_s = -1.0;  ///< from the box to what follows; -1: nothing
  std::string response;      ///< "new plan", or the reason told

  std::vector<Eigen::Vector2d> line;      ///< driven, truly
  std::vector<Eigen::Vector2d> contacts;  ///< where it collided

  double EndDistance() const { return (end.position - goal.position).norm(); }
};

/// For trials.csv.
std::string TrialHeader();
std::string TrialRow(const NavigationTrial& trial);

/// Count, median, 95 % quantile, maximum and how many took more than 100 ms.
JsonObject TimesJson(const std::vector<double>& milliseconds);

/// Over all trials, for summary.json and `--json`.
JsonObject SummaryJson(const std::vector<NavigationTrial>& trials);

}  // namespace hv::replay
