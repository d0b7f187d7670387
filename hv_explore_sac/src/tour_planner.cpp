#include "tour_planner.h"

#include <algorithm>
#include <limits>

#include "route.h"

namespace hv::explore {

Decision TourPlanner::Choose(const Observation& observation, const ExplorationModel& model) {
  ListViews(observation, model);
  distances_.assign(observation.nodes.size(), {});
  Tour best;
  best.length = std::numeric_limits<double>::infinity();
  for (int i = 0; i < config_.tour_samples; ++i) {
    Tour tour = ShortTour(SampleCover(), observation, model);
    if (tour.length < best.length) best = std::move(tour);
  }
  const int goal = best.stops.front();
  return {observation.FirstHopTo(goal), goal};
}

void TourPlanner::ListViews(const Observation& observation, const ExplorationModel& model) {
  candidates_.clear();
  seen_.clear();
  for (int i = 0; i < observation.size(); ++i) {
    if (observation.node(i).utility == 0) continue;
    candidates_.push_back(i);
    model.views().ListSeen(observation.node(i).viewpoint, seen_.emplace_back());
  }
}

/// Candidates drawn by how many points they add, until too few points are left to be worth it.
std::vector<int> TourPlanner::SampleCover() {
  std::vector<int> cover;
  std::vector<int> covered;
  std::vector<double> gains(candidates_.size());
  while (true) {
    double total = 0.0;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      const auto fresh = std::count_if(seen_[i].begin(), seen_[i].end(), [&](int point) {
        return !std::binary_search(covered.begin(), covered.end(), point);
      });
      const bool worth = fresh >= 5 || (cover.empty() && fresh > 0);
      gains[i] = worth ? static_cast<double>(fresh) : 0.0;
      total += gains[i];
    }
    if (total <= 0.0) return cover;
    std::discrete_distribution<std::size_t> draw(gains.begin(), gains.end());
    const std::size_t chosen = draw(random_);
    cover.push_back(candidates_[chosen]);
    covered.insert(covered.end(), seen_[chosen].begin(), seen_[chosen].end());
    std::sort(covered.begin(), covered.end());
  }
}

TourPlanner::Tour TourPlanner::ShortTour(std::vector<int> stops, const Observation& observation,
                                         const ExplorationModel& model) {
  int last = Observation::kRobot;
  for (auto next = stops.begin(); next != stops.end(); ++next) {
    std::iter_swap(next, std::min_element(next, stops.end(), [&](int a, int b) {
                     return Between(last, a, observation, model) <
                            Between(last, b, observation, model);
                   }));
    last = *next;
  }
  Tour tour;
  tour.length = ImproveOrder(stops, [&](const std::vector<int>& route) {
    double length = 0.0;
    int from = Observation::kRobot;
    for (const int stop : route) {
      length += Between(from, stop, observation, model);
      from = stop;
    }
    return length;
  });
  tour.stops = std::move(stops);
  return tour;
}

double TourPlanner::Between(int from, int to, const Observation& observation,
                            const ExplorationModel& model) {
  if (from == Observation::kRobot) return observation.node(to).distance;
  std::vector<float>& distances = distances_[static_cast<std::size_t>(from)];
  if (distances.empty()) {
    search_.Run(model.graph(), observation.node(from).viewpoint);
    for (const Observation::Node& node : observation.nodes) {
      // Edges are not always there both ways; by way of the robot's viewpoint all are joined.
      const float around = observation.node(from).distance + node.distance;
      distances.push_back(std::min(search_.DistanceTo(node.viewpoint), around));
    }
  }
  return distances[static_cast<std::size_t>(to)];
}

}  // namespace hv::explore
