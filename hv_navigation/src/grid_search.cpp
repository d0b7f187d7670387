#include "hv_navigation/grid_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hv::navigation {
namespace {

// Whole numbers whose ratio is that of a diagonal step, so that cells can be sorted into buckets.
constexpr int kStraight = 70;
constexpr int kDiagonal = 99;
constexpr int kUnreached = std::numeric_limits<int>::max();
constexpr int kBuckets = 2048;  // more than the estimate can grow in one step
static_assert(kBuckets > kDiagonal * (GridSearch::kMaxFactor + 1.0));

struct Step {
  int x;
  int y;
  int cost;
};
constexpr Step kSteps[8] = {{1, 0, kStraight},  {1, 1, kDiagonal},  {0, 1, kStraight},
                            {-1, 1, kDiagonal}, {-1, 0, kStraight}, {-1, -1, kDiagonal},
                            {0, -1, kStraight}, {1, -1, kDiagonal}};
constexpr std::uint8_t kStart = 8;

}  // namespace

GridSearch::GridSearch(const ClearanceGrid& grid)
    : grid_(grid), width_(grid.grid().width), open_(kBuckets) {}

void GridSearch::Clear() {
  cost_.assign(grid_.grid().cells.size(), kUnreached);
  came_by_.assign(grid_.grid().cells.size(), kStart);
  for (std::vector<int>& bucket : open_) bucket.clear();
  waiting_ = 0;
}

int GridSearch::Heuristic(const Eigen::Vector2i& cell) const {
  if (!goal_) return 0;
  const Eigen::Vector2i way = (cell - *goal_).cwiseAbs();
  return kStraight * (way.maxCoeff() - way.minCoeff()) + kDiagonal * way.minCoeff();
}

void GridSearch::Push(const Eigen::Vector2i& cell, int cost, std::uint8_t came_by) {
  const auto index = static_cast<std::size_t>(IndexOf(cell));
  if (cost >= cost_[index]) return;
  cost_[index] = cost;
  came_by_[index] = came_by;
  open_[static_cast<std::size_t>((cost + Heuristic(cell)) % kBuckets)].push_back(
      static_cast<int>(index));
  ++waiting_;
}

void GridSearch::Expand(int index, const CellFactor& factor) {
  const Eigen::Vector2i cell = CellOf(index);
  for (std::uint8_t i = 0; i < 8; ++i) {
    const Step& step = kSteps[i];
    const Eigen::Vector2i next = cell + Eigen::Vector2i(step.x, step.y);
    if (!grid_.Contains(next)) continue;
    const auto from = static_cast<std::size_t>(index);
    if (cost_[from] + step.cost >= cost_[static_cast<std::size_t>(IndexOf(next))]) continue;
    const double times = factor(next);
    if (times <= 0.0) continue;
    const int step_cost = static_cast<int>(std::lround(step.cost * std::min(times, kMaxFactor)));
    Push(next, cost_[from] + step_cost, i);
  }
}

bool GridSearch::Run(const Eigen::Vector2i& start, const Eigen::Vector2i& goal,
                     const CellFactor& factor) {
  goal_ = goal;
  return Search(start, factor);
}

void GridSearch::Flood(const Eigen::Vector2i& start, const CellFactor& factor) {
  goal_.reset();
  Search(start, factor);
}

bool GridSearch::Search(const Eigen::Vector2i& start, const CellFactor& factor) {
  Clear();
  estimate_ = Heuristic(start);
  Push(start, 0, kStart);
  for (; waiting_ > 0; ++estimate_) {
    std::vector<int>& bucket = open_[static_cast<std::size_t>(estimate_ % kBuckets)];
    while (!bucket.empty()) {
      const int index = bucket.back();
      bucket.pop_back();
      --waiting_;
      const Eigen::Vector2i cell = CellOf(index);
      const bool outdated = cost_[static_cast<std::size_t>(index)] + Heuristic(cell) != estimate_;
      if (outdated) continue;
      if (goal_ && cell == *goal_) return true;
      Expand(index, factor);
    }
  }
  return false;
}

bool GridSearch::Reached(const Eigen::Vector2i& cell) const {
  return grid_.Contains(cell) && !cost_.empty() &&
         cost_[static_cast<std::size_t>(IndexOf(cell))] != kUnreached;
}

double GridSearch::CostTo(const Eigen::Vector2i& cell) const {
  return grid_.grid().resolution_m * cost_[static_cast<std::size_t>(IndexOf(cell))] / kStraight;
}

std::vector<Eigen::Vector2i> GridSearch::RouteTo(const Eigen::Vector2i& cell) const {
  std::vector<Eigen::Vector2i> route = {cell};
  while (true) {
    const std::uint8_t came_by = came_by_[static_cast<std::size_t>(IndexOf(route.back()))];
    if (came_by == kStart) break;
    route.push_back(route.back() - Eigen::Vector2i(kSteps[came_by].x, kSteps[came_by].y));
  }
  std::reverse(route.begin(), route.end());
  return route;
}

double RouteLength(const std::vector<Eigen::Vector2i>& route, double resolution_m) {
  double cells = 0.0;
  for (std::size_t i = 1; i < route.size(); ++i) {
    cells += (route[i] - route[i - 1]).cast<double>().norm();
  }
  return cells * resolution_m;
}

}  // namespace hv::navigation
