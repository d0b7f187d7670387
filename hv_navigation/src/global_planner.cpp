#include "hv_navigation/global_planner.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "free_space.h"
#include "heading_lattice.h"
#include "path_rounding.h"
#include "route_finder.h"
#include "route_threading.h"
#include "tree_search.h"

namespace hv::navigation {
namespace {

constexpr double kGuideSpacing_m = 0.5;
constexpr double kLookAhead_m = 1.0;  // over which the route's direction is taken

/// One plan, step by step.
class Planning {
 public:
  Planning(const GlobalPlannerConfig& config, const Footprint& footprint, const ClearanceGrid& grid,
           const PlanRequest& request)
      : config_(config),
        footprint_(footprint),
        grid_(grid),
        request_(request),
        tolerance_{request.goal_tolerance_m, request.yaw_tolerance},
        space_(grid, footprint, {config.clearance_weight, config.soft_clearance_m}),
        routes_(space_) {}

  GlobalPlan Run() {
    if (!CheckStart() || !CheckGoal() || !FindShortest()) return plan_;
    double weight = config_.clearance_weight;
    PlanWith(weight);
    if (!plan_.Found() && MoveGoalToRoom()) PlanWith(weight);
    // Room is worth a detour, within limits.
    while (plan_.Found() && weight > 0.0 && TooLong()) {
      weight = weight > 0.2 ? 0.3 * weight : 0.0;
      const GlobalPlan roomier = plan_;
      PlanWith(weight);
      if (!plan_.Found() || plan_.length_m > roomier.length_m) plan_ = roomier;
    }
    return plan_;
  }

 private:
  bool Fail(PlanOutcome outcome, const std::string& reason) {
    plan_.outcome = outcome;
    plan_.reason = reason;
    return false;
  }

  bool AnyYaw() const { return tolerance_.yaw >= M_PI; }

  bool TooLong() const { return plan_.length_m > config_.max_detour * plan_.grid_length_m; }

  /// The robot may stand a little too near to something, and must then be able to leave.
  bool CheckStart() {
    if (!grid_.Contains(grid_.CellOf(request_.start.position))) {
      return Fail(PlanOutcome::kStartOutside, "the robot is outside of the map");
    }
    if (space_.IsFree(request_.start)) return true;
    const double around_m = footprint_.CircumscribedRadius() + kLookAhead_m / 2.0;
    for (const double margin_m : {footprint_.margin_m, -config_.start_slack_m}) {
      space_.AllowNear(request_.start.position, around_m, margin_m);
      if (space_.IsFree(request_.start)) break;
    }
    return space_.IsFree(request_.start) ||
           Fail(PlanOutcome::kStartBlocked, "the robot stands in an obstacle");
  }

  bool CheckGoal() {
    if (!grid_.Contains(grid_.CellOf(request_.goal.position))) {
      return Fail(PlanOutcome::kGoalOutside, "the goal is outside of the map");
    }
    std::optional<PlanarPose> goal = NearestGoal([](const Eigen::Vector2i&) { return true; });
    if (!goal && request_.approach_m > tolerance_.distance_m) {
      plan_.falls_short = true;
      tolerance_ = {request_.approach_m, M_PI};
      goal = NearestGoal(
          [this](const auto& cell) { return space_.IsFreeToTurn(grid_.CenterOf(cell)); });
    }
    if (!goal) return Fail(PlanOutcome::kGoalBlocked, "the goal is in or too near to an obstacle");
    plan_.goal = *goal;
    return true;
  }

  /// The free pose nearest to the goal, within the tolerances, in a cell that is `allowed`.
  template <typename Allowed>
  std::optional<PlanarPose> NearestGoal(const Allowed& allowed) const {
    const Eigen::Vector2i center = grid_.CellOf(request_.goal.position);
    if (allowed(center)) {
      if (const auto pose = FreeYaw(request_.goal.position)) return pose;
    }
    for (const Eigen::Vector2i& cell : CellsNear(center)) {
      if (!allowed(cell)) continue;
      if (const auto pose = FreeYaw(grid_.CenterOf(cell))) return pose;
    }
    return std::nullopt;
  }

  /// Those within the tolerance, nearest first.
  std::vector<Eigen::Vector2i> CellsNear(const Eigen::Vector2i& center) const {
    const auto distance_m = [&](const Eigen::Vector2i& cell) {
      return (grid_.CenterOf(cell) - request_.goal.position).norm();
    };
    const int radius =
        static_cast<int>(std::floor(tolerance_.distance_m / grid_.grid().resolution_m));
    std::vector<Eigen::Vector2i> cells;
    for (int y = -radius; y <= radius; ++y) {
      for (int x = -radius; x <= radius; ++x) {
        const Eigen::Vector2i cell = center + Eigen::Vector2i(x, y);
        if (grid_.Contains(cell) && distance_m(cell) <= tolerance_.distance_m) {
          cells.push_back(cell);
        }
      }
    }
    std::stable_sort(cells.begin(), cells.end(),
                     [&](const auto& a, const auto& b) { return distance_m(a) < distance_m(b); });
    return cells;
  }

  std::optional<PlanarPose> FreeYaw(const Eigen::Vector2d& position) const {
    constexpr double kStep = 0.1;
    const double tolerance = std::min(tolerance_.yaw, M_PI);
    for (double turn = 0.0; turn <= tolerance + 1e-9; turn += kStep) {
      for (const double side : {turn, -turn}) {
        const PlanarPose pose{position, request_.goal.yaw + side};
        if (space_.IsFree(pose)) return pose;
      }
    }
    return std::nullopt;
  }

  /// Whether the tolerance allows for a goal where the robot can turn.
  bool MoveGoalToRoom() {
    const auto goal = NearestGoal([this](const Eigen::Vector2i& cell) {
      return routes_.Reached(cell) && space_.IsFreeToTurn(grid_.CenterOf(cell));
    });
    if (!goal) return false;
    plan_.goal = *goal;
    return FindShortest();
  }

  bool FindShortest() {
    const Eigen::Vector2i start = grid_.CellOf(request_.start.position);
    if (!routes_.Connect(start, grid_.CellOf(plan_.goal.position))) {
      const auto goal = NearestGoal([this](const auto& cell) { return routes_.Reached(cell); });
      if (!goal) {
        return Fail(PlanOutcome::kNoConnection,
                    "no way leads to the goal that is wide enough for the robot");
      }
      plan_.goal = *goal;
    }
    routes_.Take(grid_.CellOf(plan_.goal.position));
    const Eigen::Vector2d way = plan_.goal.position - request_.start.position;
    plan_.grid_length_m =
        std::max(way.norm(), RouteLength(routes_.shortest(), grid_.grid().resolution_m));
    return true;
  }

  /// Poses along a route, from the start to the goal.
  std::vector<PlanarPose> GuideAlong(const Route& route) const {
    const double cell_m = grid_.grid().resolution_m;
    const auto spacing = static_cast<std::size_t>(std::max(1.0, kGuideSpacing_m / cell_m));
    const auto ahead = static_cast<std::size_t>(std::max(1.0, kLookAhead_m / cell_m));
    std::vector<PlanarPose> guide = {request_.start};
    for (std::size_t i = spacing; i + spacing / 2 < route.size(); i += spacing) {
      const Eigen::Vector2i& back = route[i - std::min(i, ahead / 2)];
      const Eigen::Vector2i& next = route[std::min(i + ahead / 2, route.size() - 1)];
      const Eigen::Vector2i way = next - back;
      guide.push_back({grid_.CenterOf(route[i]), std::atan2(way.y(), way.x())});
    }
    guide.push_back(Goal(guide.back()));
    return guide;
  }

  /// Where any heading will do, that of arrival.
  PlanarPose Goal(const PlanarPose& before) const {
    PlanarPose goal = plan_.goal;
    if (!AnyYaw()) return goal;
    goal.yaw = Between(before, goal).heading;
    return space_.IsFree(goal) ? goal : plan_.goal;
  }

  void PlanWith(double weight) {
    FreeSpace space = space_;
    space.SetCost({weight, config_.soft_clearance_m});
    PoseChain chain = SearchTree(space, GuideAlong(routes_.Roomy(space)), config_);
    if (chain.poses.empty()) chain = PlanThroughNarrows(space);
    if (chain.poses.empty()) chain = PlanByLattice(space);
    if (chain.poses.empty()) return FailNarrow();
    RoundingRules rules{config_.corner_radius_m, config_.path_step_m, !AnyYaw()};
    plan_.path = Rounded(space, chain.poses, rules);
    plan_.goal = plan_.path.back();
    plan_.length_m = Length(plan_.path);
    plan_.cost = chain.cost;
    Fail(PlanOutcome::kFound, "");
  }

  void FailNarrow() {
    if (space_.IsFreeToTurn(request_.start.position)) {
      Fail(PlanOutcome::kTooNarrow, "the way to the goal is too narrow for the robot to turn");
    } else {
      Fail(PlanOutcome::kCornered, "the robot has no room to turn where it stands");
    }
  }

  /// Closes, one after the other, narrow stretches that the robot does not get through, until a way
  /// is left that it does.
  PoseChain PlanThroughNarrows(const FreeSpace& space) {
    constexpr int kTries = 12;
    constexpr double kShyness = 3.0;  // of obstacles, since the route may lead anywhere
    FreeSpace shy = space;
    shy.SetCost({kShyness, config_.soft_clearance_m});
    const LatticeRules rules{config_.lattice_expansions / kTries, config_.turn_cost_m};
    for (int i = 0; i < kTries; ++i) {
      const Route route = routes_.Open(shy);
      if (route.empty()) break;
      const ThreadedRoute way = ThreadRoute(space, request_.start, plan_.goal, route, rules);
      if (!way.poses.empty()) return Improved(space, way.poses);
      routes_.Close(way.stuck);
    }
    return {};
  }

  PoseChain PlanByLattice(const FreeSpace& space) const {
    const LatticeRules rules{config_.lattice_expansions, config_.turn_cost_m};
    const std::vector<PlanarPose> guide = SearchLattice(space, request_.start, plan_.goal, rules);
    return guide.empty() ? PoseChain() : Improved(space, guide);
  }

  /// A better chain than one that was found by steps, if there is one.
  PoseChain Improved(const FreeSpace& space, const std::vector<PlanarPose>& chain) const {
    PoseChain better = SearchTree(space, chain, config_);
    if (!better.poses.empty()) return better;
    for (std::size_t i = 1; i < chain.size(); ++i) {
      if (!space.MotionIsFree(chain[i - 1], chain[i])) return {};
    }
    return {chain, 0.0};
  }

  const GlobalPlannerConfig& config_;
  const Footprint& footprint_;
  const ClearanceGrid& grid_;
  const PlanRequest& request_;
  struct {
    double distance_m;
    double yaw;  // rad
  } tolerance_;  // of the goal
  FreeSpace space_;
  RouteFinder routes_;
  GlobalPlan plan_;
};

}  // namespace

GlobalPlan GlobalPlanner::Plan(const ClearanceGrid& grid, const PlanRequest& request) const {
  const auto begin = std::chrono::steady_clock::now();
  GlobalPlan plan = Planning(config_, footprint_, grid, request).Run();
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
  plan.planning_ms = taken.count();
  return plan;
}

}  // namespace hv::navigation
