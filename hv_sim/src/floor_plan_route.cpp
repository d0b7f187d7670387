#include <algorithm>
#include <cmath>
#include <iterator>
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

constexpr double kSpacing = 0.35;    ///< [m] between waypoints
constexpr double kTurnRadius = 0.7;  ///< [m] of the circle to turn back on
constexpr double kTurnRoom = 1.45;   ///< [m] clearance at its centre
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

/// Distance [m] of every cell's centre to the nearest cell that is not free, or to the border.
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
  for (std::size_t i = 0; i < field.size(); ++i) {
    const std::size_t column = i % width;
    const std::size_t row = i / width;
    const std::size_t border = std::min({column, row, width - 1 - column, height - 1 - row}) + 1;
    const double cells = std::min(std::sqrt(field[i]), static_cast<double>(border));
    field[i] = plan.resolution * (cells - 0.5);
  }
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

  bool Open(int cell) const { return Clearance(cell) >= least_; }
  double Clearance(int cell) const { return clearance_[static_cast<std::size_t>(cell)]; }

  /// Calls `visit` with each of the eight cells around one.
  template <typename Visit>
  void ForNeighbours(int cell, Visit visit) const {
    const int column = cell % plan_.width;
    const int row = cell / plan_.width;
    for (int y = std::max(0, row - 1); y <= std::min(plan_.height - 1, row + 1); ++y) {
      for (int x = std::max(0, column - 1); x <= std::min(plan_.width - 1, column + 1); ++x) {
        if (x != column || y != row) visit(y * plan_.width + x);
      }
    }
  }

 private:
  template <typename Queue>
  void Relax(int cell, Tree& tree, Queue& queue) const {
    const Eigen::Vector2d at = plan_.Center(cell % plan_.width, cell / plan_.width);
    ForNeighbours(cell, [&](int next) {
      if (!Open(next)) return;
      const auto index = static_cast<std::size_t>(next);
      constexpr double kRoomy = 1.5;  // [m]
      const double squeeze = 1.0 + 2.0 * std::max(0.0, kRoomy - clearance_[index]);
      const double step = (plan_.Center(next % plan_.width, next / plan_.width) - at).norm();
      const double cost = tree.cost[static_cast<std::size_t>(cell)] + squeeze * step;
      if (cost >= tree.cost[index]) return;
      tree.cost[index] = cost;
      tree.parent[index] = cell;
      queue.push({cost, next});
    });
  }

  const FloorPlan& plan_;
  const std::vector<double>& clearance_;
  double least_;
};

std::vector<int> LargestComponent(const CellGraph& graph, std::size_t cell_count) {
  std::vector<bool> seen(cell_count, false);
  std::vector<int> largest;
  for (std::size_t start = 0; start < cell_count; ++start) {
    std::vector<int> component;
    const auto visit = [&](int cell) {
      const auto index = static_cast<std::size_t>(cell);
      if (seen[index] || !graph.Open(cell)) return;
      seen[index] = true;
      component.push_back(cell);
    };
    visit(static_cast<int>(start));
    for (std::size_t next = 0; next < component.size(); ++next) {
      graph.ForNeighbours(component[next], visit);
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
    const std::vector<int> area = LargestComponent(graph_, plan_.cells.size());
    if (area.empty()) return {};
    std::vector<int> places;
    std::copy_if(area.begin(), area.end(), std::back_inserter(places),
                 [this](int cell) { return graph_.Clearance(cell) >= kTurnRoom; });
    if (places.empty()) places = area;
    std::vector<int> walk = {Farthest(graph_.From({area.front()}), places)};
    constexpr int kLegs = 12;
    for (int leg = 0; leg < kLegs; ++leg) {
      if (!AppendLeg(places, random, walk) && !AppendLeg(area, random, walk)) break;
    }
    return walk;
  }

  /// Waypoints along the walk, with its staircase of cells smoothed away.
  std::vector<Vector3d> Waypoints(const std::vector<int>& walk) const {
    std::vector<Vector3d> points;
    double done = kSpacing;
    Vector2d last = Vector2d::Zero();
    for (std::size_t i = 0; i < walk.size(); ++i) {
      const Vector2d at = Smoothed(walk, static_cast<int>(i));
      if (i > 0) done += (at - last).norm();
      last = at;
      if (done < kSpacing) continue;
      points.emplace_back(at.x(), at.y(), 0.0);
      done = 0.0;
    }
    return points;
  }

 private:
  Vector2d At(int cell) const { return plan_.Center(cell % plan_.width, cell / plan_.width); }

  /// The middle of the walk about its cell `i`: of as much of it as leaves clearance.
  Vector2d Smoothed(const std::vector<int>& walk, int i) const {
    const int window = std::max(1, static_cast<int>(kSpacing / plan_.resolution));
    const int count = static_cast<int>(walk.size());
    for (int reach = std::min({window, i, count - 1 - i}); reach > 0; --reach) {
      Vector2d mean = Vector2d::Zero();
      for (int k = i - reach; k <= i + reach; ++k) mean += At(walk[static_cast<std::size_t>(k)]);
      mean /= 2 * reach + 1;
      if (graph_.Open(CellAt(mean))) return mean;
    }
    return At(walk[static_cast<std::size_t>(i)]);
  }

  static int Farthest(const CellGraph::Tree& tree, const std::vector<int>& area) {
    return *std::max_element(area.begin(), area.end(), [&tree](int a, int b) {
      return tree.cost[static_cast<std::size_t>(a)] < tree.cost[static_cast<std::size_t>(b)];
    });
  }

  /// Goes on to one of `places` far from all visited ones; false when there is no way on.
  bool AppendLeg(const std::vector<int>& places, Random& random, std::vector<int>& walk) const {
    constexpr int kCandidates = 60;
    constexpr double kNear = 3.0;  // [m]
    const CellGraph::Tree unvisited = graph_.From(walk);
    std::vector<int> goals = {Farthest(unvisited, places)};
    for (int i = 0; i < kCandidates; ++i) goals.push_back(places[random.Bits() % places.size()]);
    std::sort(goals.begin(), goals.end(), [&unvisited](int a, int b) {
      return unvisited.cost[static_cast<std::size_t>(a)] >
             unvisited.cost[static_cast<std::size_t>(b)];
    });
    const CellGraph::Tree from_here = graph_.From({walk.back()});
    for (const int goal : goals) {
      if (unvisited.cost[static_cast<std::size_t>(goal)] < kNear) return false;
      const std::vector<int> leg = PathTo(from_here, goal);
      const bool turns_back = TurnsBack(walk, leg);
      if (turns_back && graph_.Clearance(walk.back()) < kTurnRoom) continue;
      if (turns_back) {
        AppendTurn(leg, walk);
      } else {
        walk.insert(walk.end(), leg.begin() + 1, leg.end());
      }
      return true;
    }
    return false;
  }

  /// Turns on a circle around the end of the walk instead of on the spot, then takes the leg.
  void AppendTurn(const std::vector<int>& leg, std::vector<int>& walk) const {
    const Vector2d center = At(walk.back());
    const auto inside = [&](int cell) { return (At(cell) - center).norm() < kTurnRadius; };
    while (walk.size() > 1 && inside(walk.back())) walk.pop_back();
    const auto exit = std::find_if_not(leg.begin(), leg.end(), inside);
    const Vector2d in = At(walk.back()) - center;
    const Vector2d out = (exit == leg.end() ? At(leg.back()) : At(*exit)) - center;
    const double from = std::atan2(in.y(), in.x());
    double turn = std::atan2(out.y(), out.x()) - from;
    while (turn < M_PI) turn += 2.0 * M_PI;
    const int steps = static_cast<int>(kTurnRadius * turn / plan_.resolution);
    for (int i = 1; i < steps; ++i) {
      const double angle = from + turn * i / steps;
      const Vector2d at = center + kTurnRadius * Vector2d(std::cos(angle), std::sin(angle));
      walk.push_back(CellAt(at));
    }
    walk.insert(walk.end(), exit, leg.end());
  }

  int CellAt(const Vector2d& point) const {
    const Vector2d cell = (point - plan_.origin) / plan_.resolution;
    return static_cast<int>(cell.y()) * plan_.width + static_cast<int>(cell.x());
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

/// The grid to search: fine enough for rooms, coarse enough to be quick.
struct Coarse {
  FloorPlan plan;  ///< without cells' contents
  std::vector<double> clearance;
};

Coarse Coarsen(const FloorPlan& fine, const std::vector<double>& clearance) {
  const int factor = std::max(1, static_cast<int>(0.12 / fine.resolution));
  Coarse coarse{fine, {}};
  coarse.plan.width = fine.width / factor;
  coarse.plan.height = fine.height / factor;
  coarse.plan.resolution = fine.resolution * factor;
  for (int row = 0; row < coarse.plan.height; ++row) {
    for (int column = 0; column < coarse.plan.width; ++column) {
      const int center_row = row * factor + factor / 2;
      const int center_column = column * factor + factor / 2;
      const auto index =
          static_cast<std::size_t>(center_row) * static_cast<std::size_t>(fine.width) +
          static_cast<std::size_t>(center_column);
      coarse.clearance.push_back(clearance[index]);
    }
  }
  coarse.plan.cells.assign(coarse.clearance.size(), Cell::kFree);
  return coarse;
}

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

/// Longest route found that keeps `promised` [m] from everything; empty when there is none.
std::vector<Vector3d> LongestRoute(const FloorPlan& plan, double promised, std::uint32_t seed) {
  const std::vector<double> clearance = Clearance(plan);
  const Coarse coarse = Coarsen(plan, clearance);
  std::vector<Vector3d> best;
  // Smoothing and rounding cut corners, so plan with some reserve; with less if the rooms are
  // small.
  for (const double reserve : {0.4, 0.25, 0.2, 0.15, 0.08}) {
    Random random({seed});
    const RoutePlanner planner(coarse.plan, coarse.clearance, promised + reserve);
    const std::vector<Vector3d> route = planner.Waypoints(planner.Walk(random));
    const bool keeps_off = route.size() >= 2 && LeastClearance(plan, clearance, route) >=
                                                    promised + 0.7 * plan.resolution;
    if (keeps_off && Length(route) > Length(best)) best = route;
  }
  return best;
}

}  // namespace

std::vector<Vector3d> PlanRoute(const FloorPlan& plan, std::uint32_t seed) {
  constexpr double kShortest = 5.0;  // [m]
  constexpr double kWorthIt = 60.0;  // [m]
  std::vector<Vector3d> route = LongestRoute(plan, 0.6, seed);
  for (const double promised : {0.45, 0.15}) {
    if (Length(route) >= kWorthIt) break;
    std::vector<Vector3d> narrow = LongestRoute(plan, promised, seed);
    if (Length(narrow) > 2.0 * Length(route)) route = std::move(narrow);
  }
  if (Length(route) < kShortest) {
    throw InputError(plan.path + ": no way of 5 m keeps 0.15 m from all walls");
  }
  return route;
}

}  // namespace hv::sim
