#include "route_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "route.h"

namespace hv::explore {
namespace {

/// What a cell that stays unseen costs: far more than any way to it [cells].
constexpr double kMissingCost = 1000.0;

void Unite(CellSet& cells, const CellSet& added) {
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i] |= added[i];
}

}  // namespace

std::vector<int> RouteSearch::Plan(int start, const CellSet& known, std::vector<int> route,
                                   int trials) {
  start_ = start;
  known_ = known;
  std::uniform_real_distribution<double> greed(0.4, 1.6);
  Construct(route, greed(random_));
  double best = Improve(route);
  for (int i = 0; i < trials; ++i) {
    std::vector<int> other = WithGap(route);
    Construct(other, greed(random_));
    const double cost = Improve(other);
    if (cost >= best) continue;
    best = cost;
    route = std::move(other);
  }
  return route;
}

/// The route without some consecutive stops, all of them now and then.
std::vector<int> RouteSearch::WithGap(std::vector<int> route) {
  if (route.empty()) return route;
  std::uniform_int_distribution<std::size_t> place(0, route.size() - 1);
  const auto [first, last] = std::minmax({place(random_), place(random_)});
  route.erase(route.begin() + static_cast<std::ptrdiff_t>(first),
              route.begin() + static_cast<std::ptrdiff_t>(last) + 1);
  return route;
}

void RouteSearch::Cover(const std::vector<int>& route, CellSet& cells) const {
  int at = start_;
  for (const int stop : route) {
    while (at != stop) {
      at = knowledge_.NextHop(at, stop);
      Unite(cells, knowledge_.SeenFrom(at));
    }
  }
}

RouteSearch::Value RouteSearch::Evaluate(const std::vector<int>& route) {
  double length = 0.0;
  int at = start_;
  for (const int stop : route) {
    length += static_cast<double>(knowledge_.Distance(at, stop));
    at = stop;
  }
  scratch_ = known_;
  Cover(route, scratch_);
  const int unseen = knowledge_.total() - CountCells(scratch_);
  return {length, std::max(0, unseen - allowed_)};
}

double RouteSearch::Cost(const std::vector<int>& route) {
  const Value value = Evaluate(route);
  return value.length + kMissingCost * value.missing;
}

/// Adds the stop, at the best place, that shows most for its detour, until enough is seen. `greed`
/// weighs the detour.
void RouteSearch::Construct(std::vector<int>& route, double greed) {
  while (Evaluate(route).missing > 0) {
    CellSet covered = known_;
    Cover(route, covered);
    double best = 0.0;
    int best_stop = -1;
    std::size_t best_place = 0;
    for (int stop = 0; stop < knowledge_.size(); ++stop) {
      if (knowledge_.NextHop(start_, stop) < 0) continue;
      const int gain = CountMissing(covered, knowledge_.SeenFrom(stop));
      if (gain == 0) continue;
      for (std::size_t place = 0; place <= route.size(); ++place) {
        const int from = place == 0 ? start_ : route[place - 1];
        double detour = static_cast<double>(knowledge_.Distance(from, stop));
        if (place < route.size()) {
          detour += static_cast<double>(knowledge_.Distance(stop, route[place]) -
                                        knowledge_.Distance(from, route[place]));
        }
        const double value = gain / std::pow(10.0 + detour, greed);
        if (value <= best) continue;
        best = value;
        best_stop = stop;
        best_place = place;
      }
    }
    if (best_stop < 0) break;
    route.insert(route.begin() + static_cast<std::ptrdiff_t>(best_place), best_stop);
  }
}

double RouteSearch::Improve(std::vector<int>& route) {
  double cost = Cost(route);
  for (bool improved = true; improved;) {
    improved = DropStops(route, cost);
    const double ordered = ImproveOrder(route, [this](const auto& order) { return Cost(order); });
    improved |= ordered < cost - 1e-6;
    cost = ordered;
    improved |= MoveStops(route, cost);
  }
  return cost;
}

bool RouteSearch::DropStops(std::vector<int>& route, double& cost) {
  bool dropped = false;
  for (std::size_t i = 0; i < route.size();) {
    std::vector<int> trial = route;
    trial.erase(trial.begin() + static_cast<std::ptrdiff_t>(i));
    const double value = Cost(trial);
    if (value < cost + 1e-6) {
      route = std::move(trial);
      cost = value;
      dropped = true;
    } else {
      ++i;
    }
  }
  return dropped;
}

/// Tries the neighbours of each stop in its place.
bool RouteSearch::MoveStops(std::vector<int>& route, double& cost) {
  bool moved = false;
  for (int& stop : route) {
    for (const ViewpointGraph::Edge& edge : knowledge_.graph().EdgesOf(stop)) {
      const int before = stop;
      stop = edge.to;
      const double value = Cost(route);
      if (value < cost - 1e-6) {
        cost = value;
        moved = true;
        break;
      }
      stop = before;
    }
  }
  return moved;
}

}  // namespace hv::explore
