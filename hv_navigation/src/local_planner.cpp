#include "hv_navigation/local_planner.h"

#include <cmath>

#include "dynamic_window.h"
#include "path_tracker.h"
#include "rollout.h"

namespace hv::navigation {
namespace {

// Shares of the tolerances at which alignment begins and ends, so that noise does not undo them.
constexpr double kWellWithin = 0.7;
constexpr double kTurnBelow_mps = 0.05;

double Slower(double a, double b) { return std::abs(a) < std::abs(b) ? a : b; }

double Direction(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  return std::atan2(to.y() - from.y(), to.x() - from.x());
}

void Take(const std::optional<Candidate>& candidate, const char* otherwise, LocalPlan& plan) {
  plan.state = candidate ? LocalState::kDriving : LocalState::kBlocked;
  if (candidate) {
    plan.velocity = candidate->command;
    plan.trajectory = candidate->trajectory;
  } else {
    plan.reason = otherwise;
  }
}

}  // namespace

bool ObstaclesAhead::MayTouch(const Footprint& footprint, const PlanarPose& pose,
                              double after_s) const {
  if (footprint.Collides(grid, pose)) return true;
  return walkers != nullptr && after_s <= walkers->config().horizon_s &&
         walkers->MayTouch(footprint, pose, now + after_s);
}

bool ObstaclesAhead::LetStand(const Footprint& footprint, const PlanarPose& pose,
                              double from_s) const {
  constexpr double kStep_s = 0.1;
  if (walkers == nullptr) return true;
  for (double after_s = from_s; after_s <= walkers->config().horizon_s; after_s += kStep_s) {
    if (walkers->MayTouch(footprint, pose, now + after_s)) return false;
  }
  return true;
}

LocalPlanner::LocalPlanner(const LocalPlannerConfig& config, const MotionLimits& limits,
                           const Footprint& footprint)
    : config_(config),
      limits_(limits),
      footprint_(footprint),
      tracker_(std::make_unique<PathTracker>(Path())) {}

LocalPlanner::~LocalPlanner() = default;

void LocalPlanner::SetPath(const Path& path) {
  tracker_ = std::make_unique<PathTracker>(path);
  turning_ = false;
  aligning_ = false;
}

void LocalPlanner::MovePath(const PlanarPose& T_new_old) { tracker_->Move(T_new_old); }

bool LocalPlanner::PathIsFree(const ClearanceGrid& grid, const PlanarPose& T_grid_path,
                              double distance_m) const {
  const double reach_m = footprint_.CircumscribedRadius();
  Footprint bare = footprint_;
  bare.margin_m = 0.0;  // grids see walls a little apart
  const auto lies_inside = [&](const Eigen::Vector2d& position) {
    const Eigen::Vector2d reach = Eigen::Vector2d::Constant(reach_m);
    return grid.Contains(grid.CellOf(position - reach)) &&
           grid.Contains(grid.CellOf(position + reach));
  };
  // The robot is where it is: what it touches now is no news of the path.
  for (const PlanarPose& pose : tracker_->Ahead(reach_m, distance_m)) {
    const PlanarPose at = T_grid_path * pose;
    if (lies_inside(at.position) && bare.Collides(grid, at)) return false;
  }
  return true;
}

std::optional<Velocity> LocalPlanner::Turn(const ObstaclesAhead& ahead, const PlanarPose& pose,
                                           const Velocity& velocity, double turn) const {
  DynamicWindow window(config_, limits_, *tracker_, ahead);
  if (!window.Start(pose, velocity, footprint_)) return std::nullopt;
  const std::optional<Candidate> candidate = window.Turn(turn);
  if (!candidate) return std::nullopt;
  return candidate->command;
}

std::optional<Velocity> LocalPlanner::BackOff(const ObstaclesAhead& ahead, const PlanarPose& pose,
                                              const Velocity& velocity) const {
  DynamicWindow window(config_, limits_, *tracker_, ahead);
  if (!window.Start(pose, velocity, footprint_)) return std::nullopt;
  return window.Straight(-limits_.max_reverse_mps);
}

bool LocalPlanner::HasRoomToTurn(const ClearanceGrid& grid, const PlanarPose& pose) const {
  return grid.ClearanceAt(pose.position) >=
         footprint_.CircumscribedRadius() + grid.grid().resolution_m;
}

Velocity LocalPlanner::Brake(const Velocity& measured, const Velocity& asked) const {
  return Braked({Slower(measured.linear_mps, asked.linear_mps),
                 Slower(measured.angular_rps, asked.angular_rps)},
                limits_, config_.period_s);
}

LocalPlan LocalPlanner::Plan(const ObstaclesAhead& ahead, const PlanarPose& pose,
                             const Velocity& velocity) {
  LocalPlan plan;
  if (tracker_->Empty()) return plan;
  tracker_->Advance(pose.position);
  plan.remaining_m = tracker_->Remaining();
  plan.off_path_m = tracker_->Nearest(pose.position, config_.look_ahead_m).distance_m;
  DynamicWindow window(config_, limits_, *tracker_, ahead);
  if (!window.Start(pose, velocity, footprint_)) {
    plan.state = LocalState::kBlocked;
    plan.reason = "the robot stands in an obstacle";
    return plan;
  }
  plan.state = LocalState::kDriving;
  if (IsAtGoal(pose)) {
    Align(window, pose, velocity, plan);
  } else {
    Follow(window, pose, velocity, plan);
  }
  return plan;
}

bool LocalPlanner::IsAtGoal(const PlanarPose& pose) {
  const double off_m = (tracker_->goal().position - pose.position).norm();
  const double enough_m = (aligning_ ? 1.0 : kWellWithin) * config_.goal_tolerance_m;
  aligning_ = tracker_->OnLastStretch() && off_m <= enough_m;
  return aligning_;
}

void LocalPlanner::Align(const DynamicWindow& window, const PlanarPose& pose,
                         const Velocity& velocity, LocalPlan& plan) const {
  const double turn = WrappedAngle(tracker_->goal().yaw - pose.yaw);
  const bool stands = Stands(velocity);
  if (stands && std::abs(turn) <= config_.goal_yaw_tolerance) {
    plan.state = LocalState::kReached;
    return;
  }
  const bool moves = std::abs(velocity.linear_mps) > kTurnBelow_mps;
  if (moves || std::abs(turn) <= kWellWithin * config_.goal_yaw_tolerance) return;
  Take(window.Turn(turn), "no room to turn at the goal", plan);
}

void LocalPlanner::Follow(const DynamicWindow& window, const PlanarPose& pose,
                          const Velocity& velocity, LocalPlan& plan) {
  const Eigen::Vector2d ahead = tracker_->PointAhead(config_.look_ahead_m);
  const double turn = WrappedAngle(Direction(pose.position, ahead) - pose.yaw);
  if (std::abs(turn) > config_.turn_from) turning_ = true;
  if (std::abs(turn) < config_.turn_until) turning_ = false;
  if (turning_) {
    if (std::abs(velocity.linear_mps) > kTurnBelow_mps) return;
    Take(window.Turn(turn), "no room to turn", plan);
    if (plan.state == LocalState::kDriving) return;
  }
  Take(window.Drive(), "something is in the way", plan);
}

}  // namespace hv::navigation
