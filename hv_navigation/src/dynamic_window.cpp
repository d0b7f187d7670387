#include "dynamic_window.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rollout.h"

namespace hv::navigation {
namespace {

constexpr double kMarginStep_m = 0.01;
constexpr double kStanding_mps = 0.02;
constexpr double kStanding_rps = 0.05;
constexpr double kCompared_m = 3.0;  // of the path that is compared
constexpr double kLeastProgress_m = 0.005;

}  // namespace

bool Stands(const Velocity& velocity) {
  return std::abs(velocity.linear_mps) < kStanding_mps &&
         std::abs(velocity.angular_rps) < kStanding_rps;
}

bool DynamicWindow::Start(const PlanarPose& pose, const Velocity& velocity,
                          const Footprint& footprint) {
  pose_ = pose;
  now_ = velocity;
  footprint_ = footprint;
  while (footprint_.Collides(grid_, pose)) {
    // Who stands a little too near must be able to leave.
    footprint_.margin_m -= kMarginStep_m;
    if (footprint_.margin_m < -config_.margin_slack_m) return false;
  }
  tight_ = footprint_.margin_m < footprint.margin_m;
  if (tight_) footprint_.margin_m -= kMarginStep_m;
  return true;
}

std::optional<Candidate> DynamicWindow::Drive() const {
  std::optional<Candidate> best;
  const double fastest_mps = SpeedLimit();
  for (int i = 1; i <= config_.speeds; ++i) {
    const double speed_mps = fastest_mps * i / config_.speeds;
    for (int k = 0; k <= config_.turns; ++k) {
      const Velocity target{speed_mps, k < config_.turns ? TurnRate(k) : PursuitRate(speed_mps)};
      Candidate candidate;
      candidate.command = Towards(now_, target, limits_, config_.period_s);
      if (!CanStop(candidate.command) || !Rollout(target, candidate)) continue;
      if (!best || candidate.score > best->score) best = std::move(candidate);
    }
  }
  return best;
}

/// On the spot a robot stays where it is: where the margin leaves no room, the bare footprint may.
std::optional<Candidate> DynamicWindow::Turn(double turn) const {
  const double other = turn - std::copysign(2.0 * M_PI, turn);
  const Footprint standing = AsFarAsNow();
  Footprint bare = standing;
  bare.margin_m = std::min(bare.margin_m, 0.0);
  const double stop_s = config_.period_s + config_.reaction_s +
                        std::abs(now_.angular_rps) / limits_.angular_acceleration_rps2;
  if (!ahead_.OutOfReach(footprint_, pose_, stop_s)) return std::nullopt;
  if (!ahead_.LetStand(footprint_, pose_, 0.0)) return std::nullopt;
  for (const Footprint& footprint : {standing, bare}) {
    for (const double way : {turn, other}) {
      if (!footprint.CollidesTurning(grid_, pose_, way)) return TurnCandidate(way);
    }
  }
  return std::nullopt;
}

std::optional<Velocity> DynamicWindow::Straight(double speed_mps) const {
  const Velocity command = Towards(now_, {speed_mps, 0.0}, limits_, config_.period_s);
  if (!CanStop(command)) return std::nullopt;
  return command;
}

/// The footprint that keeps off everything by as much as the robot does now.
Footprint DynamicWindow::AsFarAsNow() const {
  Footprint footprint = footprint_;
  if (tight_) footprint.margin_m += kMarginStep_m;
  return footprint;
}

/// Before everything that stands, and where those who walk let it.
bool DynamicWindow::CanStop(Velocity velocity) const {
  const double step_s = 0.5 * config_.step_s;
  const double brake_s = config_.period_s + config_.reaction_s;
  PlanarPose pose = pose_;
  double time_s = 0.0;
  while (time_s < brake_s || !Stands(velocity)) {
    if (time_s >= brake_s) velocity = Braked(velocity, limits_, step_s);
    pose = Driven(pose, velocity, step_s);
    time_s += step_s;
    if (ahead_.MayTouch(footprint_, pose, time_s)) return false;
  }
  // Who may leave a place that is too near to something must not get nearer, cycle by cycle.
  if (tight_ && AsFarAsNow().Collides(grid_, pose)) return false;
  // Who stands does not start for a moment.
  constexpr double kStart_s = 0.5;
  const double before_s = Stands(now_) ? time_s + kStart_s : time_s;
  if (!ahead_.OutOfReach(footprint_, pose, before_s)) return false;
  return ahead_.LetStand(footprint_, pose, time_s);
}

double DynamicWindow::TurnRate(int k) const {
  return limits_.max_angular_rps * (2.0 * k / (config_.turns - 1) - 1.0);
}

/// Leads on a circle to the point ahead.
double DynamicWindow::PursuitRate(double speed_mps) const {
  const Eigen::Vector2d ahead = pose_.Inverse() * tracker_.PointAhead(config_.look_ahead_m);
  const double squared = std::max(ahead.squaredNorm(), 0.01);
  return std::clamp(2.0 * speed_mps * ahead.y() / squared, -limits_.max_angular_rps,
                    limits_.max_angular_rps);
}

/// Slower near obstacles, and so that it can stop softly at the end of the stretch.
double DynamicWindow::SpeedLimit() const {
  double clearance_m = grid_.ClearanceAt(pose_.position);
  const double step_m = 2.0 * grid_.grid().resolution_m;
  for (double ahead_m = 0.0; ahead_m <= 1.0; ahead_m += step_m) {
    clearance_m = std::min(clearance_m, grid_.ClearanceAt(tracker_.PointAhead(ahead_m)));
  }
  const double room =
      std::clamp((clearance_m - footprint_.InscribedRadius()) / config_.slow_clearance_m, 0.0, 1.0);
  const double by_room_mps = config_.slow_mps + room * (limits_.max_linear_mps - config_.slow_mps);
  const double to_stop_m =
      std::max(tracker_.ToStop(), (tracker_.StopPoint() - pose_.position).norm());
  return std::min(
      {by_room_mps, std::sqrt(2.0 * config_.approach_mps2 * to_stop_m), limits_.max_linear_mps});
}

double DynamicWindow::Nearness(const PlanarPose& pose) const {
  const double depth = 1.0 - (grid_.ClearanceAt(pose.position) - footprint_.InscribedRadius()) /
                                 config_.slow_clearance_m;
  return std::clamp(depth, 0.0, 1.0);
}

/// Along the path; towards the end of the stretch where that is near, since it may lie aside.
double DynamicWindow::Progress(const PlanarPose& pose) const {
  if (tracker_.ToStop() < 0.5 * config_.look_ahead_m) {
    const Eigen::Vector2d stop = tracker_.StopPoint();
    return (pose_.position - stop).norm() - (pose.position - stop).norm();
  }
  return tracker_.Nearest(pose.position, kCompared_m).along_m - tracker_.Along();
}

/// Simulates to the horizon, or to the first obstacle, and scores. False when it does not get on.
bool DynamicWindow::Rollout(const Velocity& target, Candidate& candidate) const {
  const double to_stop_m = (tracker_.StopPoint() - pose_.position).norm();
  const double enough_s =
      std::max(to_stop_m, tracker_.ToStop()) / std::max(target.linear_mps, 0.01);
  const int steps = std::max(
      3, static_cast<int>(std::ceil(std::min(config_.horizon_s, enough_s) / config_.step_s)));
  Velocity velocity = now_;
  PlanarPose pose = pose_;
  double nearness = 0.0;
  double off_path_m = 0.0;
  int free = 0;
  for (; free < steps; ++free) {
    velocity = Towards(velocity, target, limits_, config_.step_s);
    pose = Driven(pose, velocity, config_.step_s);
    if (ahead_.MayTouch(footprint_, pose, config_.step_s * (free + 1))) break;
    candidate.trajectory.push_back(pose);
    nearness += Nearness(pose);
    off_path_m += tracker_.Nearest(pose.position, kCompared_m).distance_m;
  }
  if (free == 0) return false;
  const PlanarPose& last = candidate.trajectory.back();
  const double heading =
      WrappedAngle(tracker_.Nearest(last.position, kCompared_m).heading - last.yaw);
  const double change =
      std::abs(candidate.command.angular_rps - now_.angular_rps) / limits_.max_angular_rps +
      std::abs(candidate.command.linear_mps - now_.linear_mps) / limits_.max_linear_mps;
  const double progress_m = Progress(last);
  candidate.score =
      config_.progress_weight * progress_m / (limits_.max_linear_mps * config_.horizon_s) -
      config_.path_weight * off_path_m / free - config_.heading_weight * std::abs(heading) -
      config_.clearance_weight * nearness / free - config_.smoothness_weight * change -
      config_.collision_weight * (1.0 - static_cast<double>(free) / steps);
  return progress_m > kLeastProgress_m;
}

Candidate DynamicWindow::TurnCandidate(double turn) const {
  // Slower towards the end, so that it stops there.
  const double rate_rps = 0.7 * std::sqrt(2.0 * limits_.angular_acceleration_rps2 * std::abs(turn));
  const double last_rps = std::abs(turn) / config_.period_s;
  Candidate candidate;
  const Velocity target{
      0.0, std::copysign(std::min({rate_rps, last_rps, limits_.max_angular_rps}), turn)};
  candidate.command = Towards(now_, target, limits_, config_.period_s);
  constexpr int kPoses = 8;
  for (int i = 1; i <= kPoses; ++i) {
    candidate.trajectory.push_back({pose_.position, pose_.yaw + turn * i / kPoses});
  }
  return candidate;
}

}  // namespace hv::navigation
