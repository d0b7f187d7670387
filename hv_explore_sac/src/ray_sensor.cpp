#include "hv_explore_sac/ray_sensor.h"

#include <cmath>
#include <map>
#include <utility>

#include "hv_explore_sac/grid_line.h"

namespace hv::explore {
namespace {

/// The tree of rays while it grows.
struct Branch {
  std::map<std::pair<int, int>, Branch> next;
};

}  // namespace

RaySensor::RaySensor(const SimulationConfig& config) : wall_depth_(config.wall_depth) {
  Branch root;
  for (int ray = 0; ray < config.rays; ++ray) {
    const double angle = 2.0 * M_PI * ray / config.rays;
    const Eigen::Vector2i end(static_cast<int>(std::lround(config.range * std::cos(angle))),
                              static_cast<int>(std::lround(config.range * std::sin(angle))));
    Branch* at = &root;
    WalkLine({0, 0}, end, [&](int x, int y) {
      at = &at->next[{x, y}];
      return true;
    });
  }
  const auto append = [this](const auto& self, const Branch& branch, int parent) -> void {
    for (const auto& [cell, below] : branch.next) {
      const std::size_t index = tree_.size();
      tree_.push_back({static_cast<std::int16_t>(cell.first),
                       static_cast<std::int16_t>(cell.second), parent, 0});
      self(self, below, static_cast<int>(index));
      tree_[index].end = static_cast<std::int32_t>(tree_.size());
    }
  };
  append(append, root, -1);
}

void RaySensor::Sense(const ExplorationMap& map, const Eigen::Vector2i& from,
                      Belief& belief) const {
  Cast(map, from, [&belief](int index, bool is_free) {
    belief.Set(index, is_free ? Cell::kFree : Cell::kOccupied);
  });
}

}  // namespace hv::explore
