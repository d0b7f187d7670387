#include "hv_navigation/obstacle_memory.h"

#include <algorithm>
#include <utility>

namespace hv::navigation {
namespace {

constexpr std::size_t kMostMemories = 4;

}  // namespace

bool SeenObstacles::IsFreeAt(const Eigen::Vector2d& place) const {
  const Eigen::Vector2i cell = grid->CellOf(T_map_grid.Inverse() * place);
  if (!grid->Contains(cell)) return false;
  const std::int8_t value = grid->grid().At(cell.x(), cell.y());
  return value != OccupancyGrid::kUnknown && !OccupancyGrid::IsOccupied(value);
}

std::vector<Eigen::Vector2d> SeenObstacles::MissingIn(const ClearanceGrid& map) const {
  const OccupancyGrid& cells = grid->grid();
  const double known_m = 1.5 * map.grid().resolution_m;
  std::vector<Eigen::Vector2d> places;
  for (int row = 0; row < cells.height; ++row) {
    for (int column = 0; column < cells.width; ++column) {
      if (!OccupancyGrid::IsOccupied(cells.At(column, row))) continue;
      const Eigen::Vector2d place = T_map_grid * grid->CenterOf({column, row});
      const Eigen::Vector2i cell = map.CellOf(place);
      if (map.Contains(cell) && map.ClearanceAt(cell) > known_m) places.push_back(place);
    }
  }
  return places;
}

void ObstacleMemory::Add(Time now, std::vector<Eigen::Vector2d> places) {
  memories_.push_back({now, std::move(places)});
  if (memories_.size() > kMostMemories) memories_.pop_front();
}

void ObstacleMemory::Review(Time now, const SeenObstacles& seen) {
  while (!memories_.empty() && now - memories_.front().stamp > keep_s_) memories_.pop_front();
  for (Memory& memory : memories_) {
    std::vector<Eigen::Vector2d>& places = memory.places;
    const auto is_free = [&](const Eigen::Vector2d& place) { return seen.IsFreeAt(place); };
    places.erase(std::remove_if(places.begin(), places.end(), is_free), places.end());
  }
}

std::vector<Eigen::Vector2d> ObstacleMemory::Places() const {
  std::vector<Eigen::Vector2d> places;
  for (const Memory& memory : memories_) {
    places.insert(places.end(), memory.places.begin(), memory.places.end());
  }
  return places;
}

}  // namespace hv::navigation
