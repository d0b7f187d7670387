#pragma once

#include <string>

#include "hv_core/config.h"
#include "hv_navigation/clearance_grid.h"
#include "hv_navigation/footprint.h"
#include "hv_navigation/path.h"

namespace hv::navigation {

/// How paths through the map are sought.
struct GlobalPlannerConfig {
  int samples = 100;
  int seed = 1;
  double range_m = 2.0;
  double tube_m = 0.5;
  double uniform_share = 0.1;
  double soft_clearance_m = 0.35;
  double clearance_weight = 1.0;
  double turn_cost_m = 0.15;
  double max_detour = 1.15;
  double start_slack_m = 0.1;
  double corner_radius_m = 0.6;
  double path_step_m = 0.1;
  int lattice_expansions = 50000;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

struct PlanRequest {
  PlanarPose start;
  PlanarPose goal;
  double goal_tolerance_m = 0.0;  ///< how far off the goal may be moved when it is not free
  double yaw_tolerance = 0.0;     ///< and turned [rad]; from pi on any heading will do
  double approach_m = 0.0;        ///< where nothing of that is free, how near it will do to get
};

enum class PlanOutcome {
  kFound,
  kStartOutside,  ///< of the grid
  kStartBlocked,  ///< inside an obstacle, more than slightly
  kGoalOutside,
  kGoalBlocked,   ///< and so is all within the tolerance
  kNoConnection,  ///< not even a robot as slim as the inscribed circle passes
  kTooNarrow,     ///< somewhere the way is too narrow to turn
  kCornered,      ///< or the place where the robot stands is; backing out may help
};

struct GlobalPlan {
  PlanOutcome outcome = PlanOutcome::kNoConnection;
  std::string reason;        ///< one line; empty when found
  Path path;                 ///< from the start to `goal`, drivable ahead and by turns on the spot
  PlanarPose goal;           ///< the goal, or the free pose within the tolerance
  bool falls_short = false;  ///< the goal is not free: `goal` is the nearest place to turn
  double length_m = 0.0;
  double grid_length_m = 0.0;  ///< the shortest way of the inscribed circle over cells
  double cost = 0.0;           ///< length with the nearness of obstacles and turns counted [m]
  double planning_ms = 0.0;

  bool Found() const { return outcome == PlanOutcome::kFound; }
};

/// Plans for a differential drive: A* over the grid proves that a way exists and how short it can
/// be; RRT* (Karaman and Frazzoli 2011, as OMPL has it) then searches poses in a tube around that
/// way, with the exact footprint, for a path that is short and keeps away from obstacles. It stops
/// after a number of samples, so that the result depends on the seed alone. Const methods may run
/// concurrently.
class GlobalPlanner {
 public:
  GlobalPlanner(const GlobalPlannerConfig& config, const Footprint& footprint)
      : config_(config), footprint_(footprint) {}

  /// Never throws; a request that makes no sense has an outcome and a reason. The distances of
  /// `grid` should reach the circumscribed radius plus `soft_clearance_m`.
  GlobalPlan Plan(const ClearanceGrid& grid, const PlanRequest& request) const;

 private:
  GlobalPlannerConfig config_;
  Footprint footprint_;
};

}  // namespace hv::navigation
