#pragma once

#include <optional>

#include "hv_navigation/local_planner.h"
#include "path_tracker.h"

namespace hv::navigation {

/// One of the velocities to be tried, and what comes of it.
struct Candidate {
  Velocity command;  ///< for the next period
  Path trajectory;
  double score = 0.0;
};

bool Stands(const Velocity& velocity);

/// What can be driven in one cycle. Holds references.
class DynamicWindow {
 public:
  DynamicWindow(const LocalPlannerConfig& config, const MotionLimits& limits,
                const PathTracker& tracker, const ObstaclesAhead& ahead)
      : config_(config), limits_(limits), tracker_(tracker), ahead_(ahead), grid_(ahead.grid) {}

  /// False when the robot stands in an obstacle: then no motion can be judged.
  bool Start(const PlanarPose& pose, const Velocity& velocity, const Footprint& footprint);

  /// The best of the velocities ahead; nullopt when none gets on that is safe.
  std::optional<Candidate> Drive() const;

  /// Turns on the spot by `turn`, or the other way round; nullopt when something is in both ways.
  std::optional<Candidate> Turn(double turn) const;

  /// Straight on at `speed_mps`, which may be negative; nullopt when that is not safe.
  std::optional<Velocity> Straight(double speed_mps) const;

 private:
  bool CanStop(Velocity velocity) const;
  Footprint AsFarAsNow() const;
  double TurnRate(int k) const;
  double PursuitRate(double speed_mps) const;
  double SpeedLimit() const;
  double Nearness(const PlanarPose& pose) const;
  double Progress(const PlanarPose& pose) const;
  bool Rollout(const Velocity& target, Candidate& candidate) const;
  Candidate TurnCandidate(double turn) const;

  const LocalPlannerConfig& config_;
  const MotionLimits& limits_;
  const PathTracker& tracker_;
  const ObstaclesAhead& ahead_;
  const ClearanceGrid& grid_;  ///< of them
  PlanarPose pose_;
  Velocity now_;
  Footprint footprint_;
  bool tight_ = false;  ///< it stands nearer to something than it should
};

}  // namespace hv::navigation
