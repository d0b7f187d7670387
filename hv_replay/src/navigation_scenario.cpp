#include "hv_replay/navigation_scenario.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "hv_core/error.h"

namespace hv::replay {
namespace {

using Eigen::Vector2d;
using navigation::ClearanceGrid;
using navigation::Path;
using navigation::PlanarPose;

constexpr double kFast_mps = 0.4;
constexpr double kStraight_rps = 0.3;
constexpr double kStraight = 0.15;  ///< rad, to what lies ahead

// The lowest ray, 16 deg down from 0.6 m above the floor and 0.12 m before the base, is 0.15 m high
// at 1.69 m. A box whose far corner is nearer is under it.
constexpr double kLowAhead_m = 1.35;  ///< up to a step of the path more
constexpr double kLowSide_m = 0.3;
constexpr double kLowHeight_m = 0.15;
constexpr double kLowRoom_m = 1.15;  ///< about its middle: 1 m on both sides
constexpr double kLowLeft_m = 2.5;   ///< of the plan

constexpr double kBlockAhead_m = 3.0;
constexpr double kBlockThick_m = 0.3;
constexpr double kBlockHeight_m = 1.2;
constexpr double kBlockLeft_m = 5.0;  ///< of the plan
constexpr double kBlock_s = 60.0;
constexpr double kWidest_m = 4.5;    ///< of a corridor
constexpr double kAlongAxis = 0.14;  ///< rad

std::size_t NearestOn(const Path& plan, const Vector2d& position) {
  const auto nearest =
      std::min_element(plan.begin(), plan.end(), [&](const PlanarPose& a, const PlanarPose& b) {
        return (a.position - position).squaredNorm() < (b.position - position).squaredNorm();
      });
  return static_cast<std::size_t>(nearest - plan.begin());
}

/// Where the plan gets `distance_m` away, if that lies straight ahead.
std::optional<Vector2d> StraightAhead(const DriveSituation& situation, double distance_m) {
  const bool fast = situation.velocity.linear_mps > kFast_mps &&
                    std::abs(situation.velocity.angular_rps) < kStraight_rps;
  if (!fast || situation.plan.empty()) return std::nullopt;
  const PlanarPose base = navigation::Planar(situation.T_map_world * situation.T_world_base);
  for (std::size_t i = NearestOn(situation.plan, base.position); i < situation.plan.size(); ++i) {
    const Vector2d way = situation.plan[i].position - base.position;
    if (way.norm() < distance_m) continue;
    const double turn = navigation::WrappedAngle(std::atan2(way.y(), way.x()) - base.yaw);
    if (std::abs(turn) > kStraight) return std::nullopt;
    return situation.plan[i].position;
  }
  return std::nullopt;
}

Vector2d InWorld(const DriveSituation& situation, const Vector2d& in_map) {
  return navigation::Planar(situation.T_map_world).Inverse() * in_map;
}

std::optional<sim::TimedBox> LowBox(const DriveSituation& situation) {
  if (situation.remaining_m < kLowAhead_m + kLowLeft_m) return std::nullopt;
  const std::optional<Vector2d> at = StraightAhead(situation, kLowAhead_m);
  if (!at || situation.map.ClearanceAt(*at) < kLowRoom_m) return std::nullopt;
  const double floor_m = situation.T_world_base.translation().z();
  const Vector2d center = InWorld(situation, *at);
  sim::TimedBox box;
  box.center << center, floor_m + 0.5 * kLowHeight_m;
  box.size << kLowSide_m, kLowSide_m, kLowHeight_m;
  box.from_s = situation.time_s;
  return box;
}

/// From a free place to the first obstacle in a direction; nullopt beyond the widest corridor.
std::optional<double> ToWall(const ClearanceGrid& map, const Vector2d& from, const Vector2d& way) {
  const double step_m = 0.5 * map.grid().resolution_m;
  for (double along_m = 0.0; along_m < kWidest_m; along_m += step_m) {
    if (map.OccupiedAt(from + along_m * way)) return along_m;
  }
  return std::nullopt;
}

std::optional<sim::TimedBox> Barrier(const DriveSituation& situation) {
  if (situation.remaining_m < kBlockAhead_m + kBlockLeft_m) return std::nullopt;
  const std::optional<Vector2d> at = StraightAhead(situation, kBlockAhead_m);
  if (!at) return std::nullopt;
  const double yaw = navigation::Planar(situation.T_world_base).yaw;
  const double axis = 0.5 * M_PI * std::round(yaw / (0.5 * M_PI));
  if (std::abs(yaw - axis) > kAlongAxis) return std::nullopt;
  const Vector2d across_world(-std::sin(axis), std::cos(axis));
  const Vector2d across = navigation::Planar(situation.T_map_world) * across_world -
                          navigation::Planar(situation.T_map_world).position;
  const std::optional<double> left = ToWall(situation.map, *at, across);
  const std::optional<double> right = ToWall(situation.map, *at, -across);
  if (!left || !right || *left + *right > kWidest_m) return std::nullopt;
  constexpr double kIntoWalls_m = 0.1;
  const double width_m = *left + *right + 2.0 * kIntoWalls_m;
  const Vector2d center = InWorld(situation, *at) + 0.5 * (*left - *right) * across_world;
  const bool along_x = std::abs(across_world.y()) > 0.5;
  sim::TimedBox box;
  box.center << center, situation.T_world_base.translation().z() + 0.5 * kBlockHeight_m;
  box.size << (along_x ? kBlockThick_m : width_m), (along_x ? width_m : kBlockThick_m),
      kBlockHeight_m;
  box.from_s = situation.time_s;
  box.until_s = situation.time_s + kBlock_s;
  return box;
}

}  // namespace

NavigationScenario ParseScenario(const std::string& name) {
  if (name == "random") return NavigationScenario::kRandom;
  if (name == "low_obstacles") return NavigationScenario::kLowObstacles;
  if (name == "blocked_corridor") return NavigationScenario::kBlockedCorridor;
  throw InputError("scenario '" + name +
                   "' is unknown; known are random, low_obstacles, blocked_corridor");
}

std::optional<sim::TimedBox> BoxAhead(NavigationScenario scenario,
                                      const DriveSituation& situation) {
  switch (scenario) {
    case NavigationScenario::kRandom:
      return std::nullopt;
    case NavigationScenario::kLowObstacles:
      return LowBox(situation);
    case NavigationScenario::kBlockedCorridor:
      return Barrier(situation);
  }
  return std::nullopt;
}

bool LeadsPast(const Path& plan, const DriveSituation& situation, const sim::TimedBox& box,
               double radius_m) {
  const PlanarPose base = navigation::Planar(situation.T_map_world * situation.T_world_base);
  const Vector2d half = 0.5 * box.size.head<2>();
  const Eigen::AlignedBox2d ground(Vector2d(box.center.head<2>() - half),
                                   Vector2d(box.center.head<2>() + half));
  for (std::size_t i = NearestOn(plan, base.position); i < plan.size(); ++i) {
    if (ground.exteriorDistance(InWorld(situation, plan[i].position)) < radius_m) return false;
  }
  return true;
}

}  // namespace hv::replay
