#include "heading_lattice.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <queue>
#include <unordered_map>

#include "hv_navigation/grid_search.h"

namespace hv::navigation {
namespace {

constexpr int kHeadings = 16;
constexpr double kLeastStep_m = 0.1;

/// Steps on the lattice, by heading.
const Eigen::Vector2i& StepOf(int heading) {
  static const std::vector<Eigen::Vector2i> steps = {
      {1, 0},  {2, 1},   {1, 1},   {1, 2},   {0, 1},  {-1, 2}, {-1, 1}, {-2, 1},
      {-1, 0}, {-2, -1}, {-1, -1}, {-1, -2}, {0, -1}, {1, -2}, {1, -1}, {2, -1}};
  return steps[static_cast<std::size_t>(heading)];
}

double YawOf(int heading) { return std::atan2(StepOf(heading).y(), StepOf(heading).x()); }

struct Node {
  Eigen::Vector2i place;  ///< in steps from the start
  int heading = 0;
};

std::int64_t KeyOf(const Node& node) {
  constexpr std::int64_t kHalf = 1 << 20;
  return ((node.place.x() + kHalf) * 2 * kHalf + node.place.y() + kHalf) * kHeadings + node.heading;
}

struct Visit {
  Node node;
  double cost = std::numeric_limits<double>::infinity();
  std::int64_t parent = -1;
  bool closed = false;
};

struct Open {
  double estimate;
  std::int64_t key;
  bool operator<(const Open& other) const {
    return estimate != other.estimate ? estimate > other.estimate : key > other.key;
  }
};

class Lattice {
 public:
  Lattice(const FreeSpace& space, const PlanarPose& start, const PlanarPose& goal,
          const LatticeRules& rules)
      : space_(space), start_(start), goal_(goal), rules_(rules), to_goal_(space.grid()) {
    const double cell_m = space.grid().grid().resolution_m;
    step_m_ = cell_m * std::max(1.0, std::round(kLeastStep_m / cell_m));
    to_goal_.Flood(space.grid().CellOf(goal.position), [this](const Eigen::Vector2i& cell) {
      const Eigen::Vector2d center = space_.grid().CenterOf(cell);
      if ((center - goal_.position).norm() > rules_.reach_m) return 0.0;
      return space_.grid().ClearanceAt(cell) >= space_.NeededClearance(center) ? 1.0 : 0.0;
    });
  }

  std::vector<PlanarPose> Run() {
    if (space_.MotionIsFree(start_, goal_)) return {start_, goal_};
    for (int heading = 0; heading < kHeadings; ++heading) {
      const double turn = WrappedAngle(YawOf(heading) - start_.yaw);
      if (!space_.TurnIsFree(start_, turn)) continue;
      Push({Eigen::Vector2i::Zero(), heading}, rules_.turn_cost_m * std::abs(turn), -1);
    }
    for (int i = 0; i < rules_.expansions && !open_.empty(); ++i) {
      const std::int64_t key = open_.top().key;
      open_.pop();
      Visit& visit = visits_[key];
      if (visit.closed) continue;
      visit.closed = true;
      const Node node = visit.node;
      if (ReachesGoal(node)) return ChainTo(key);
      Expand(node, visit.cost, key);
    }
    return {};
  }

 private:
  PlanarPose PoseOf(const Node& node) const {
    return {start_.position + step_m_ * node.place.cast<double>(), YawOf(node.heading)};
  }

  bool ReachesGoal(const Node& node) const {
    const PlanarPose pose = PoseOf(node);
    return (pose.position - goal_.position).norm() <= 2.0 * step_m_ &&
           space_.MotionIsFree(pose, goal_);
  }

  void Push(const Node& node, double cost, std::int64_t parent) {
    const Eigen::Vector2i cell = space_.grid().CellOf(PoseOf(node).position);
    if (!to_goal_.Reached(cell)) return;
    const std::int64_t key = KeyOf(node);
    Visit& visit = visits_[key];
    if (visit.closed || cost >= visit.cost) return;
    visit = {node, cost, parent, false};
    open_.push({cost + to_goal_.CostTo(cell), key});
  }

  void Expand(const Node& node, double cost, std::int64_t key) {
    const PlanarPose pose = PoseOf(node);
    const Eigen::Vector2i& step = StepOf(node.heading);
    const double length_m = step_m_ * step.cast<double>().norm();
    if (space_.DriveIsFree(pose, length_m)) {
      const Node next{node.place + step, node.heading};
      Push(next, cost + space_.DriveCost(pose.position, PoseOf(next).position), key);
    }
    for (const int side : {1, kHeadings - 1}) {
      const Node next{node.place, (node.heading + side) % kHeadings};
      const double turn = WrappedAngle(YawOf(next.heading) - pose.yaw);
      if (!space_.TurnIsFree(pose, turn)) continue;
      Push(next, cost + rules_.turn_cost_m * std::abs(turn), key);
    }
  }

  std::vector<PlanarPose> ChainTo(std::int64_t key) const {
    std::vector<PlanarPose> chain = {goal_};
    for (; key >= 0; key = visits_.at(key).parent) chain.push_back(PoseOf(visits_.at(key).node));
    chain.push_back(start_);
    std::reverse(chain.begin(), chain.end());
    return chain;
  }

  const FreeSpace& space_;
  PlanarPose start_;
  PlanarPose goal_;
  LatticeRules rules_;
  GridSearch to_goal_;
  double step_m_ = 0.1;
  std::unordered_map<std::int64_t, Visit> visits_;
  std::priority_queue<Open> open_;
};

}  // namespace

std::vector<PlanarPose> SearchLattice(const FreeSpace& space, const PlanarPose& start,
                                      const PlanarPose& goal, const LatticeRules& rules) {
  return Lattice(space, start, goal, rules).Run();
}

}  // namespace hv::navigation
