#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hv_core/config.h"
#include "hv_navigation/clearance_grid.h"
#include "hv_navigation/footprint.h"
#include "hv_navigation/motion_limits.h"
#include "hv_navigation/path.h"
#include "hv_navigation/walkers.h"

namespace hv::navigation {

/// How a path is followed.
struct LocalPlannerConfig {
  double period_s = 0.1;
  double reaction_s = 0.1;
  double horizon_s = 2.0;
  double step_s = 0.1;
  int speeds = 6;
  int turns = 19;
  double look_ahead_m = 0.8;
  double turn_from = 0.8;
  double turn_until = 0.2;
  double goal_tolerance_m = 0.1;
  double goal_yaw_tolerance = 0.1;
  double approach_mps2 = 0.4;
  double slow_mps = 0.3;
  double slow_clearance_m = 0.3;
  double margin_slack_m = 0.1;
  double progress_weight = 1.0;
  double path_weight = 1.5;
  double heading_weight = 0.15;
  double clearance_weight = 0.3;
  double smoothness_weight = 0.05;
  double collision_weight = 2.0;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

enum class LocalState {
  kNoPath,
  kDriving,
  kBlocked,  ///< nothing but to stand (or to brake) is safe and leads on
  kReached,  ///< stands at the end of the path, within the tolerances
};

struct LocalPlan {
  LocalState state = LocalState::kNoPath;
  std::optional<Velocity> velocity;  ///< for the next period; nullopt: to brake
  Path trajectory;                   ///< where that leads within the horizon
  std::string reason;
  double remaining_m = 0.0;  ///< of the path
  double off_path_m = 0.0;   ///< distance of the robot from the path
};

/// What the next seconds are driven through: what stands, and who walks. Holds references.
struct ObstaclesAhead {
  ObstaclesAhead(const ClearanceGrid& what_stands, const Walkers* who_walks = nullptr,
                 Time at = Time())
      : grid(what_stands), walkers(who_walks), now(at) {}

  const ClearanceGrid& grid;
  const Walkers* walkers;  ///< null: nobody
  Time now;

  /// Whether the robot with its margin may touch anything at `pose`, where it is `after_s` from
  /// now.
  bool MayTouch(const Footprint& footprint, const PlanarPose& pose, double after_s) const;
  /// Whether those who walk, and may turn, cannot get to the robot by then.
  bool OutOfReach(const Footprint& footprint, const PlanarPose& pose, double after_s) const {
    return walkers == nullptr || !walkers->MayReach(footprint, pose, now + after_s);
  }
  /// Whether those who walk let a robot stand at `pose` from `from_s` from now on.
  bool LetStand(const Footprint& footprint, const PlanarPose& pose, double from_s) const;
};

class DynamicWindow;
class PathTracker;

/// Follows a path by the dynamic window approach (Fox, Burgard and Thrun 1997): simulates what the
/// limits allow, keeps what can still stop before every obstacle and out of the way of those who
/// walk, with the exact footprint, and takes what gets on best along the path. Turns on the spot
/// where the path has sharp corners or begins behind. Not thread-safe.
class LocalPlanner {
 public:
  LocalPlanner(const LocalPlannerConfig& config, const MotionLimits& limits,
               const Footprint& footprint);
  ~LocalPlanner();

  /// Starts to follow `path`, given in the frame of the grids; an empty one ends following.
  void SetPath(const Path& path);

  /// Moves the path being followed into another frame, to which odometry has come.
  void MovePath(const PlanarPose& T_new_old);

  /// Whether the robot fits at all poses of the path within `distance_m` ahead, as far as `grid`
  /// reaches; its frame may be another one than that of the path.
  bool PathIsFree(const ClearanceGrid& grid, const PlanarPose& T_grid_path,
                  double distance_m) const;

  /// One cycle. `velocity` is the one driven now. Total: without a path, or where nothing is safe,
  /// the velocity is to brake.
  LocalPlan Plan(const ObstaclesAhead& ahead, const PlanarPose& pose, const Velocity& velocity);

  /// Turns on the spot by `turn`, either way round, or backs off straight: the velocity for the
  /// next period; nullopt when that is not safe.
  std::optional<Velocity> Turn(const ObstaclesAhead& ahead, const PlanarPose& pose,
                               const Velocity& velocity, double turn) const;
  std::optional<Velocity> BackOff(const ObstaclesAhead& ahead, const PlanarPose& pose,
                                  const Velocity& velocity) const;

  /// Whether the robot can turn at `pose` with a cell to spare.
  bool HasRoomToTurn(const ClearanceGrid& grid, const PlanarPose& pose) const;

  /// Slows down as fast as allowed, along the circle driven now. What is measured lags behind what
  /// was asked for in the cycle before, so that it brakes from the slower of both.
  Velocity Brake(const Velocity& measured, const Velocity& asked) const;

 private:
  bool IsAtGoal(const PlanarPose& pose);
  void Align(const DynamicWindow& window, const PlanarPose& pose, const Velocity& velocity,
             LocalPlan& plan) const;
  void Follow(const DynamicWindow& window, const PlanarPose& pose, const Velocity& velocity,
              LocalPlan& plan);

  LocalPlannerConfig config_;
  MotionLimits limits_;
  Footprint footprint_;
  std::unique_ptr<PathTracker> tracker_;
  bool turning_ = false;   ///< on the spot, towards the path
  bool aligning_ = false;  ///< at the goal, towards its yaw
};

}  // namespace hv::navigation
