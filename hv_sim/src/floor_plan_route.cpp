#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "hv_core/error.h"
#include "hv_sim/floor_plan.h"
#include "hv_sim/random.h"
#include "hv_sim/route.h"

namespace hv::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPromised = 0.6;   ///< [m] between route and walls
constexpr double kSpacing = 1.0;    ///< [m] between waypoints
constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr int kOutside = -1;

/// Lower envelope of parabolas in one dimension (Felzenszwalb and Huttenlocher, 2012).
void TransformLine(std::vector<double>& line) {
  const int count = static_cast<int>(line.size());
  std::vector<int> apex;
  std::vector<double> from;
  for (int q = 0; q < count; ++q) {
    const double value = line[static_cast<std::size_t>(q)];
    if (value == kFar) continue;
    double start = -kFar;
    while (!apex.empty()) {
      const int p = apex.back();
      start = (value + q * q - line[static_cast<std::size_t>(p)] - p * p) / (2.0 * (q - p));
      if (start > from.back()) break;
      apex.pop_back();
      from.pop_back();
      start = -kFar;
    }
    apex.push_back(q);
    from.push_back(start);
  }
  if (apex.empty()) return;
  std::vector<double> result(line.size());
  std::size_t k = 0;
  for (int q = 0; q < count; ++q) {
    while (k + 1 < apex.size() && from[k + 1] < q) ++k;
    const double gap = q - apex[k];
    result[static_cast<std::size_t>(q)] = gap * gap + line[static_cast<std::size_t>(apex[k])];
  }
  line = std::move(result);
}

/// Distance [m] of every cell's centre to the nearest cell that is not free.
std::vector<double> Clearance(const FloorPlan& plan) {
  const auto width = static_cast<std::size_t>(plan.width);
  const auto height = static_cast<std::size_t>(plan.height);
  std::vector<double> field(plan.cells.size());
  std::transform(plan.cells.begin(), plan.cells.end(), field.begin(),
                 [](Cell cell) { return cell == Cell::kFree ? kFar : 0.0; });
  std::vector<double> line(height);
  for (std::size_t column = 0; column < width; ++column) {
    for (std::size_t row = 0; row < height; ++row) line[row] = field[row * width + column];
    TransformLine(line);
    for (std::size_t row = 0; row < height; ++row) field[row * width + column] = line[row];
  }
  line.resize(width);
  for (std::size_t row = 0; row < height; ++row) {
    const auto first = field.begin() + static_cast<std::ptrdiff_t>(row * width);
    std::copy(first, first + plan.width, line.begin());
    TransformLine(line);
    std::copy(line.begin(), line.end(), first);
  }
  for (double& value : field) value = plan.resolution * (std::sqrt(value) - 0.5);
  return field;
}

/// Shortest paths over cells that keep `least` clearance, with a liking for the middle of rooms.
class CellGraph {
 public:
  struct Tree {
    std::vector<double> cost;
    std::vector<int> parent;
  };

  CellGraph(const FloorPlan& plan, const std::vector<double>& clearance, double least)
      : plan_(plan), clearance_(clearance), least_(least) {}

  Tree From(const std::vector<int>& sources) const {
    Tree tree{std::vector<double>(clearance_.size(), kFar),
              std::vector<int>(clearance_.size(), kOutside)};
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const int source : sources) {
      tree.cost[static_cast<std::size_t>(source)] = 0.0;
      queue.push({0.0, source});
    }
    while (!queue.empty()) {
      const auto [cost, cell] = queue.top();
      queue.pop();
      if (cost > tree.cost[static_cast<std::size_t>(cell)]) continue;
      Relax(cell, tree, queue);
    }
    return tree;
  }

  bool Open(int cell) const { return clearance_[static_cast<std::size_t>(cell)] >= least_; }

 private:
  template <typename Queue>
  void Relax(int cell, Tree& tree, Queue& queue) const {
    const int column = cell % plan_.width;
    const int row = cell / plan_.width;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const int x = column + dx;
        const int y = row + dy;
        if (x < 0 || y < 0 || x >= plan_.width || y >= plan_.height) continue;
        const int next = y * plan_.width + x;
        if (!Open(next)) continue;
        const auto index = static_cast<std::size_t>(next);
        constexpr double kRoomy = 1.5;  // [m]
        const double squeeze = 1.0 + 2.0 * std::max(0.0, kRoomy - clearance_[index]);
        const double cost = tree.cost[static_cast<std::size_t>(cell)] +
                            squeeze * plan_.resolution * std::hypot(dx, dy);
        if (cost >= tree.cost[index]) continue;
        tree.cost[index] = cost;
        tree.parent[index] = cell;
        queue.push({cost, next});
      }
    }
  }

  const FloorPlan& plan_;
  const std::vector<double>& clearance_;
  double least_;
};

std::vector<int> LargestComponent(const CellGraph& graph, int cell_count) {
  std::vector<bool> seen(static_cast<std::size_t>(cell_count), false);
  std::vector<int> largest;
  for (int cell = 0; cell < cell_count; ++cell) {
    if (seen[static_cast<std::size_t>(cell)] || !graph.Open(cell)) continue;
    const CellGraph::Tree tree = graph.From({cell});
    std::vector<int> component;
    for (int other = 0; other < cell_count; ++other) {
      if (tree.cost[static_cast<std::size_t>(other)] == kFar) continue;
      seen[static_cast<std::size_t>(other)] = true;
      component.push_back(other);
    }
    if (component.size() > largest.size()) largest = std::move(component);
  }
  return largest;
}

std::vector<int> PathTo(const CellGraph::Tree& tree, int goal) {
  std::vector<int> path;
  for (int cell = goal; cell != kOutside; cell = tree.parent[static_cast<std::size_t>(cell)]) {
    path.push_back(cell);
  }
  std::reverse(path.begin(), path.end());
  return path;
}

class RoutePlanner {
 public:
  RoutePlanner(const FloorPlan& plan, const std::vector<double>& clearance, double least)
      : plan_(plan), graph_(plan, clearance, least) {}

  /// Cells of a walk that visits far places one after the other.
  std::vector<int> Walk(Random& random) const {
    const std::vector<int> area = LargestComponent(graph_, plan_.width * plan_.height);
    if (area.empty()) return {};
    const int start = Farthest(graph_.From({area.front()}), area);
    std::vector<int> walk = {start};
    constexpr int kLegs = 12;
    for (int leg = 0; leg < kLegs; ++leg) {
      if (!AppendLeg(area, random, walk)) break;
    }
    return walk;
  }

  /// Waypoints along the walk, with its staircase of cells smoothed away.
  std::vector<Vector3d> Waypoints(const std::vector<int>& walk) const {
    const int window = std::max(1, static_cast<int>(0.5 * kSpacing / plan_.resolution));
    const int count = static_cast<int>(walk.size());
    std::vector<Vector3d> points;
    double done = kSpacing;
    Vector2d last = Vector2d::Zero();
    for (int i = 0; i < count; ++i) {
      const int reach = std::min({window, i, count - 1 - i});
      Vector2d mean = Vector2d::Zero();
      for (int k = i - reach; k <= i + reach; ++k) mean += At(walk[static_cast<std::size_t>(k)]);
      mean /= 2 * reach + 1;
      if (i > 0) done += (mean - last).norm();
      last = mean;
      if (done < kSpacing) continue;
      points.emplace_back(mean.x(), mean.y(), 0.0);
      done = 0.0;
    }
    return points;
  }

 private:
  Vector2d At(int cell) const { return plan_.Center(cell % plan_.width, cell / plan_.width); }

  static int Farthest(const CellGraph::Tree& tree, const std::vector<int>& area) {
    return *std::max_element(area.begin(), area.end(), [&tree](int a, int b) {
      return tree.cost[static_cast<std::size_t>(a)] < tree.cost[static_cast<std::size_t>(b)];
    });
  }

  /// Goes on to a place far from all visited ones; false when every way there turns back.
  bool AppendLeg(const std::vector<int>& area, Random& random, std::vector<int>& walk) const {
    constexpr int kCandidates = 60;
    constexpr double kNear = 3.0;  // [m]
    const CellGraph::Tree unvisited = graph_.From(walk);
    std::vector<int> goals = {Farthest(unvisited, area)};
    for (int i = 0; i < kCandidates; ++i) goals.push_back(area[random.Bits() % area.size()]);
    std::sort(goals.begin(), goals.end(), [&unvisited](int a, int b) {
      return unvisited.cost[static_cast<std::size_t>(a)] >
             unvisited.cost[static_cast<std::size_t>(b)];
    });
    const CellGraph::Tree from_here = graph_.From({walk.back()});
    for (const int goal : goals) {
      if (unvisited.cost[static_cast<std::size_t>(goal)] < kNear) return false;
      const std::vector<int> leg = PathTo(from_here, goal);
      if (TurnsBack(walk, leg)) continue;
      walk.insert(walk.end(), leg.begin() + 1, leg.end());
      return true;
    }
    return false;
  }

  bool TurnsBack(const std::vector<int>& walk, const std::vector<int>& leg) const {
    const auto reach = static_cast<std::size_t>(1.5 / plan_.resolution);
    if (walk.size() <= reach || leg.size() <= reach) return walk.size() > 1;
    const Vector2d in = At(walk.back()) - At(walk[walk.size() - 1 - reach]);
    const Vector2d out = At(leg[reach]) - At(leg.front());
    return in.dot(out) < -0.3 * in.norm() * out.norm();
  }

  const FloorPlan& plan_;
  CellGraph graph_;
};

double LeastClearance(const FloorPlan& plan, const std::vector<double>& clearance,
                      const std::vector<Vector3d>& route) {
  double least = kFar;
  for (const double radius : {0.0, 1.0}) {
    for (const Vector3d& point : SampleRoute(route, false, radius, 0.5 * plan.resolution)) {
      const Vector2d cell = (point.head<2>() - plan.origin) / plan.resolution;
      const auto index = static_cast<std::size_t>(cell.y()) * static_cast<std::size_t>(plan.width) +
                         static_cast<std::size_t>(cell.x());
      least = std::min(least, clearance[index]);
    }
  }
  return least;
}

double Length(const std::vector<Vector3d>& route) {
  double length = 0.0;
  for (std::size_t i = 1; i < route.size(); ++i) length += (route[i] - route[i - 1]).norm();
  return length;
}

}  // namespace

std::vector<Vector3d> PlanRoute(const FloorPlan& plan, std::uint32_t seed) {
  constexpr double kShortest = 5.0;  // [m]
  const std::vector<double> clearance = Clearance(plan);
  std::vector<Vector3d> best;
  // Smoothing and rounding cut corners, so plan with some reserve; with less if the rooms are small.
  for (const double reserve : {0.35, 0.2, 0.1}) {
    Random random({seed});
    const RoutePlanner planner(plan, clearance, kPromised + reserve + plan.resolution);
    const std::vector<Vector3d> route = planner.Waypoints(planner.Walk(random));
    if (route.size() < 2 || LeastClearance(plan, clearance, route) < kPromised + plan.resolution) {
      continue;
    }
    if (Length(route) > Length(best)) best = route;
  }
  if (Length(best) < kShortest) {
    throw InputError(plan.path + ": no way of " + std::to_string(static_cast<int>(kShortest)) +
                     " m keeps 0.6 m from all walls");
  }
  return best;
}

}  // namespace hv::sim
