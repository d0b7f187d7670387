#include "motion_plan.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "motion_path.h"

namespace hv::sim {
namespace {

constexpr int kSplineReach = 3;       ///< controls on either side that shape an instant
constexpr double kCreepSpeed = 0.08;  ///< slowest advance towards a stop [m/s]
constexpr double kStopSeconds = 2.5;

class Planner {
 public:
  Planner(const MotionConfig& config, const PlanProfile& profile)
      : profile_(profile), random_(static_cast<std::uint32_t>(config.seed)) {
    const double steps = std::ceil((config.skip_s + config.duration_s) / profile.step_s);
    wanted_ = static_cast<std::size_t>(steps) + 2 * kSplineReach;
  }

  bool done() const { return controls_.size() >= wanted_; }
  std::vector<Controls> Take() { return std::move(controls_); }

  void Stand(const PathRun& run, std::size_t index, double seconds, double activity) {
    const auto steps = static_cast<int>(std::ceil(seconds / profile_.step_s));
    for (int k = 0; k < steps; ++k) controls_.push_back(At(run, index, 0.0, activity));
  }

  /// Turns on the spot until the heading is that of the start of `next`.
  void TurnTo(const PathRun& next) {
    const Controls from = controls_.back();
    const double angle = std::remainder(next.yaw.front() - from[kYaw], 2.0 * M_PI);
    const double seconds = 0.5 * M_PI * std::abs(angle) / profile_.yaw_rate;
    const auto steps = static_cast<int>(std::ceil(seconds / profile_.step_s));
    for (int k = 1; k <= steps; ++k) {
      Controls control = from;
      control[kYaw] += angle * 0.5 * (1.0 - std::cos(M_PI * k / steps));
      controls_.push_back(control);
    }
    yaw_offset_ = from[kYaw] + angle - next.yaw.front();
  }

  void Drive(const PathRun& run) {
    const std::vector<std::size_t> stops = PlaceStops(run);
    const std::vector<double> speed = LimitSpeed(run, stops);
    std::size_t begin = 0;
    for (const std::size_t end : stops) {
      DriveTo(run, speed, begin, end);
      if (done()) return;
      Stand(run, end, kStopSeconds, profile_.idle_activity);
      begin = end;
    }
  }

 private:
  Controls At(const PathRun& run, std::size_t index, double share, double activity) const {
    const std::size_t next = std::min(index + 1, run.points.size() - 1);
    const auto mix = [share](double a, double b) { return a + share * (b - a); };
    Controls control;
    control.head<3>() = run.points[index] + share * (run.points[next] - run.points[index]);
    control[kZ] += profile_.height;
    control[kYaw] = mix(run.yaw[index], run.yaw[next]) + yaw_offset_;
    const double slope = mix(run.slope[index], run.slope[next]);
    control[kPitch] = profile_.follows_slope ? -std::asin(std::clamp(slope, -1.0, 1.0)) : 0.0;
    control[kActivity] = activity;
    return control;
  }

  /// Indices at which the run pauses; the last one is its end.
  std::vector<std::size_t> PlaceStops(const PathRun& run) {
    std::vector<std::size_t> stops;
    std::uniform_real_distribution<double> spread(0.6, 1.4);
    if (profile_.stop_every > 0.0) {
      double at = profile_.stop_every * spread(random_);
      for (; at < run.length() - 0.3 * profile_.stop_every;
           at += profile_.stop_every * spread(random_)) {
        stops.push_back(static_cast<std::size_t>(at / PathRun::kSpacing));
      }
    }
    stops.push_back(run.points.size() - 1);
    return stops;
  }

  /// Speed at each point that respects corners, stops and the acceleration [m/s].
  std::vector<double> LimitSpeed(const PathRun& run, const std::vector<std::size_t>& stops) const {
    std::vector<double> speed(run.points.size(), profile_.speed);
    for (std::size_t i = 0; i < speed.size(); ++i) {
      const double curvature = std::max(std::abs(run.curvature[i]), 1e-6);
      speed[i] = std::min(profile_.speed, profile_.yaw_rate / curvature);
    }
    speed.front() = 0.0;
    for (const std::size_t stop : stops) speed[stop] = 0.0;
    const double gain = 2.0 * profile_.acceleration * PathRun::kSpacing;
    for (std::size_t i = 1; i < speed.size(); ++i) {
      speed[i] = std::min(speed[i], std::sqrt(speed[i - 1] * speed[i - 1] + gain));
    }
    for (std::size_t i = speed.size() - 1; i > 0; --i) {
      speed[i - 1] = std::min(speed[i - 1], std::sqrt(speed[i] * speed[i] + gain));
    }
    return speed;
  }

  void DriveTo(const PathRun& run, const std::vector<double>& speed, std::size_t begin,
               std::size_t end) {
    double position = static_cast<double>(begin);
    while (position < static_cast<double>(end) && !done()) {
      const auto index = static_cast<std::size_t>(position);
      const double share = position - static_cast<double>(index);
      const double planned = speed[index] + share * (speed[index + 1] - speed[index]);
      const double pace = std::max(planned, kCreepSpeed);
      const double activity =
          std::max(profile_.idle_activity, std::min(1.0, 2.0 * pace / profile_.speed));
      controls_.push_back(At(run, index, share, activity));
      position += pace * profile_.step_s / PathRun::kSpacing;
    }
  }

  PlanProfile profile_;
  std::mt19937 random_;
  std::size_t wanted_ = 0;
  std::vector<Controls> controls_;
  double yaw_offset_ = 0.0;
};

}  // namespace

std::vector<Controls> PlanControls(const World& world, const MotionConfig& config,
                                   const PlanProfile& profile) {
  const double length = profile.speed * (config.skip_s + config.duration_s) + 1.0;
  const std::vector<PathRun> runs = MakePath(world, length, profile.corner);
  Planner planner(config, profile);
  planner.Stand(runs.front(), 0, config.still_s + kSplineReach * profile.step_s, 0.0);
  for (std::size_t i = 0; i < runs.size() && !planner.done(); ++i) {
    if (i > 0) planner.TurnTo(runs[i]);
    planner.Drive(runs[i]);
  }
  return planner.Take();
}

}  // namespace hv::sim
