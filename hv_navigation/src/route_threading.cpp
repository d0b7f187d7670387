#include "route_threading.h"

#include <algorithm>
#include <cmath>

namespace hv::navigation {
namespace {

constexpr double kSpacing_m = 0.5;    // of poses where there is room
constexpr double kDirection_m = 0.4;  // over which the direction of the route is taken
constexpr double kAside_m = 2.0;      // by which a search may leave the stretch

class Threading {
 public:
  Threading(const FreeSpace& space, const PlanarPose& start, const PlanarPose& goal,
            const Route& route, const LatticeRules& rules)
      : space_(space), goal_(goal), route_(route), rules_(rules) {
    result_.poses = {start};
    for (const Eigen::Vector2i& cell : route) {
      roomy_.push_back(space.IsFreeToTurn(space.grid().CenterOf(cell)));
    }
  }

  ThreadedRoute Run() {
    for (std::size_t i = 0; i < route_.size();) {
      if (roomy_[i]) {
        Advance(i++);
        continue;
      }
      const auto end = static_cast<std::size_t>(
          std::find(roomy_.begin() + static_cast<std::ptrdiff_t>(i), roomy_.end(), true) -
          roomy_.begin());
      if (!PassNarrow(i, end)) return Stuck(i, end);
      i = end;
    }
    if (roomy_.back()) result_.poses.push_back(goal_);
    return result_;
  }

 private:
  PlanarPose PoseAt(std::size_t i) const {
    const double cell_m = space_.grid().grid().resolution_m;
    const auto reach = static_cast<std::size_t>(std::ceil(kDirection_m / cell_m));
    const Eigen::Vector2i& back = route_[i - std::min(i, reach)];
    const Eigen::Vector2i& next = route_[std::min(i + reach, route_.size() - 1)];
    const Eigen::Vector2i way = next - back;
    return {space_.grid().CenterOf(route_[i]), std::atan2(way.y(), way.x())};
  }

  /// Where the next cell is narrow the robot stands in line with what follows.
  void Advance(std::size_t i) {
    const bool before_narrow = i + 1 < route_.size() && !roomy_[i + 1];
    const PlanarPose pose = PoseAt(i);
    const double driven_m = (pose.position - result_.poses.back().position).norm();
    if (before_narrow || driven_m >= kSpacing_m) result_.poses.push_back(pose);
  }

  bool PassNarrow(std::size_t begin, std::size_t end) {
    const PlanarPose to = end < route_.size() ? PoseAt(end) : goal_;
    LatticeRules rules = rules_;
    rules.reach_m = kAside_m + kSpacing_m +
                    space_.grid().grid().resolution_m * static_cast<double>(end - begin) * M_SQRT2;
    const std::vector<PlanarPose> chain = SearchLattice(space_, result_.poses.back(), to, rules);
    if (chain.empty()) return false;
    result_.poses.insert(result_.poses.end(), chain.begin() + 1, chain.end());
    return true;
  }

  ThreadedRoute Stuck(std::size_t begin, std::size_t end) const {
    return {{},
            {route_.begin() + static_cast<std::ptrdiff_t>(begin),
             route_.begin() + static_cast<std::ptrdiff_t>(end)}};
  }

  const FreeSpace& space_;
  const PlanarPose& goal_;
  const Route& route_;
  const LatticeRules& rules_;
  std::vector<bool> roomy_;  ///< whether the robot can turn at the cells of the route
  ThreadedRoute result_;
};

}  // namespace

ThreadedRoute ThreadRoute(const FreeSpace& space, const PlanarPose& start, const PlanarPose& goal,
                          const Route& route, const LatticeRules& rules) {
  return Threading(space, start, goal, route, rules).Run();
}

}  // namespace hv::navigation
