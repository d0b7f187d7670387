#include "hv_navigation/global_planner.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "free_space.h"
#include "heading_lattice.h"
#include "hv_navigation/grid_search.h"
#include "path_rounding.h"
#include "tree_search.h"

namespace hv::navigation {
namespace {

constexpr double kBand_m = 1.5;  // about the shortest route, for the one with room
constexpr double kGuideSpacing_m = 0.5;
constexpr double kEnd_m = 1.0;        // about start and goal, where there may be no room to turn
constexpr double kLookAhead_m = 1.0;  // over which the route's direction is taken

using Cells = std::vector<Eigen::Vector2i>;

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
        search_(grid) {}

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
    Cells cells = CellsNear(center);
    for (const Eigen::Vector2i& cell : cells) {
      if (!allowed(cell)) continue;
      if (const auto pose = FreeYaw(grid_.CenterOf(cell))) return pose;
    }
    return std::nullopt;
  }

  /// Cells within the tolerance, nearest first.
  Cells CellsNear(const Eigen::Vector2i& center) const {
    const auto distance_m = [&](const Eigen::Vector2i& cell) {
      return (grid_.CenterOf(cell) - request_.goal.position).norm();
    };
    const int radius =
        static_cast<int>(std::floor(tolerance_.distance_m / grid_.grid().resolution_m));
    Cells cells;
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
      return search_.Reached(cell) && space_.IsFreeToTurn(grid_.CenterOf(cell));
    });
    if (!goal) return false;
    plan_.goal = *goal;
    return FindShortest();
  }

  double InscribedFactor(const Eigen::Vector2i& cell) const {
    const double needed_m = space_.NeededClearance(grid_.CenterOf(cell));
    return grid_.ClearanceAt(cell) >= needed_m ? 1.0 : 0.0;
  }

  bool FindShortest() {
    const Eigen::Vector2i start = grid_.CellOf(request_.start.position);
    const auto factor = [this](const Eigen::Vector2i& cell) {
      return cell == grid_.CellOf(plan_.goal.position) ? 1.0 : InscribedFactor(cell);
    };
    if (!search_.Run(start, grid_.CellOf(plan_.goal.position), factor)) {
      const auto goal = NearestGoal([this](const auto& cell) { return search_.Reached(cell); });
      if (!goal) {
        return Fail(PlanOutcome::kNoConnection,
                    "no way leads to the goal that is wide enough for the robot");
      }
      plan_.goal = *goal;
    }
    shortest_ = search_.RouteTo(grid_.CellOf(plan_.goal.position));
    const Eigen::Vector2d way = plan_.goal.position - request_.start.position;
    plan_.grid_length_m = std::max(way.norm(), RouteLength(shortest_, grid_.grid().resolution_m));
    return true;
  }

  std::vector<std::uint8_t> BandMask() const {
    const OccupancyGrid& cells = grid_.grid();
    std::vector<std::uint8_t> mask(cells.cells.size(), 0);
    const int radius = static_cast<int>(std::ceil(kBand_m / cells.resolution_m));
    for (std::size_t i = 0; i < shortest_.size(); ++i) {
      const bool stamp = i % static_cast<std::size_t>(std::max(1, radius / 4)) == 0;
      if (!stamp && i + 1 != shortest_.size()) continue;
      const Eigen::Vector2i low = (shortest_[i].array() - radius).max(0);
      const Eigen::Vector2i high =
          (shortest_[i].array() + radius).min(Eigen::Array2i(cells.width, cells.height) - 1);
      for (int y = low.y(); y <= high.y(); ++y) {
        const auto row = mask.begin() + static_cast<std::ptrdiff_t>(y) * cells.width;
        std::fill(row + low.x(), row + high.x() + 1, std::uint8_t{1});
      }
    }
    return mask;
  }

  /// A route near the shortest one that keeps away from obstacles.
  Cells RoomyRoute(const FreeSpace& space) {
    const std::vector<std::uint8_t> mask = BandMask();
    const Eigen::Vector2i goal = grid_.CellOf(plan_.goal.position);
    const auto factor = [&](const Eigen::Vector2i& cell) {
      const std::ptrdiff_t index =
          static_cast<std::ptrdiff_t>(cell.y()) * grid_.grid().width + cell.x();
      if (mask[static_cast<std::size_t>(index)] == 0) return 0.0;
      const double open = cell == goal ? 1.0 : InscribedFactor(cell);
      return open * (1.0 + space.Nearness(grid_.ClearanceAt(cell)));
    };
    return search_.Run(shortest_.front(), goal, factor) ? search_.RouteTo(goal) : shortest_;
  }

  /// The shortest route with room to turn everywhere but about the start and the goal; empty when
  /// there is none.
  Cells RouteToTurn() {
    const Eigen::Vector2i goal = grid_.CellOf(plan_.goal.position);
    const auto is_end = [this](const Eigen::Vector2i& cell) {
      const Eigen::Vector2d at = grid_.CenterOf(cell);
      return (at - request_.start.position).norm() < kEnd_m ||
             (at - plan_.goal.position).norm() < kEnd_m;
    };
    const auto factor = [&](const Eigen::Vector2i& cell) {
      if (grid_.ClearanceAt(cell) >= space_.circumscribed_m() || cell == goal) return 1.0;
      return is_end(cell) ? InscribedFactor(cell) : 0.0;
    };
    return search_.Run(shortest_.front(), goal, factor) ? search_.RouteTo(goal) : Cells();
  }

  /// Poses along a route, from the start to the goal.
  std::vector<PlanarPose> GuideAlong(const Cells& route) const {
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
    PoseChain chain = SearchTree(space, GuideAlong(RoomyRoute(space)), config_);
    if (chain.poses.empty()) chain = PlanWithRoom(space);
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

  /// The shortest way may lead where the robot fits through but cannot turn; another may not.
  PoseChain PlanWithRoom(const FreeSpace& space) {
    const Cells route = RouteToTurn();
    return route.empty() ? PoseChain() : SearchTree(space, GuideAlong(route), config_);
  }

  PoseChain PlanByLattice(const FreeSpace& space) const {
    const LatticeRules rules{config_.lattice_expansions, config_.turn_cost_m};
    const std::vector<PlanarPose> guide = SearchLattice(space, request_.start, plan_.goal, rules);
    if (guide.empty()) return {};
    PoseChain better = SearchTree(space, guide, config_);
    return better.poses.empty() ? PoseChain{guide, 0.0} : better;
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
  GridSearch search_;
  Cells shortest_;
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
