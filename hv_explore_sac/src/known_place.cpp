#include "hv_explore_sac/known_place.h"

#include <cmath>
#include <limits>
#include <utility>

#include "hv_explore_sac/grid_line.h"

namespace hv::explore {
namespace {

Cell KindOf(std::int8_t cell) {
  if (cell == OccupancyGrid::kUnknown) return Cell::kUnknown;
  return OccupancyGrid::IsOccupied(cell) ? Cell::kOccupied : Cell::kFree;
}

int FloorTo(int value, int multiple) {
  return static_cast<int>(std::floor(static_cast<double>(value) / multiple)) * multiple;
}

/// The cell of `frame` over the first cell of the map.
Eigen::Vector2i ShiftOf(const OccupancyGrid& map, const CellFrame& frame) {
  return ((map.origin - frame.origin) / frame.cell_m).array().round().cast<int>();
}

/// Places farther apart were not driven between: the robot was carried, or the map has moved.
constexpr double kLongestStep_m = 2.0;

void OpenAround(const Eigen::Vector2i& center, const Belief& belief, Belief& ground) {
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      const Eigen::Vector2i cell = center + Eigen::Vector2i(x, y);
      if (!belief.Contains(cell) || belief.At(cell) != Cell::kFree) continue;
      ground.Set(ground.IndexOf(cell), Cell::kFree);
    }
  }
}

void OpenDriven(const std::vector<Eigen::Vector2i>& driven, double cell_m, const Belief& belief,
                Belief& ground) {
  for (std::size_t i = 0; i < driven.size(); ++i) {
    OpenAround(driven[i], belief, ground);
    if (i == 0) continue;
    const Eigen::Vector2i& before = driven[i - 1];
    if ((driven[i] - before).cast<double>().norm() * cell_m > kLongestStep_m) continue;
    WalkLine(before, driven[i], [&](int x, int y) {
      OpenAround({x, y}, belief, ground);
      return true;
    });
  }
}

}  // namespace

ExplorationModel ModelOf(const navigation::ClearanceGrid& clearance, const CellFrame& frame,
                         const PlaceRules& rules, const ExplorationConfig& config) {
  const OccupancyGrid& map = clearance.grid();
  const Eigen::Vector2i shift = ShiftOf(map, frame);
  // Blocks of frontiers keep their places too.
  const int block = config.frontier.block;
  const Eigen::Vector2i low(FloorTo(shift.x(), block), FloorTo(shift.y(), block));
  const Eigen::Vector2i size = shift - low + Eigen::Vector2i(map.width, map.height);
  ExplorationModel model(config, size.x(), size.y(), low);
  Belief& belief = model.belief();
  Belief ground = belief;
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const Eigen::Vector2i cell(x, y);
      const int index = belief.IndexOf(shift + cell);
      const bool outside = !rules.bounds.Contains(map.CenterOf(cell));
      const Cell known = outside ? Cell::kOccupied : KindOf(map.At(x, y));
      const bool near = clearance.ClearanceAt(cell) < rules.room_m;
      belief.Set(index, known);
      ground.Set(index, near ? Cell::kOccupied : known);
    }
  }
  OpenDriven(rules.driven, frame.cell_m, belief, ground);
  model.SetGround(std::move(ground));
  return model;
}

std::optional<Eigen::Vector2i> NearestFree(const Belief& belief, const CellFrame& frame,
                                           const Eigen::Vector2d& position, double reach_m) {
  const Eigen::Vector2i center = frame.CellOf(position);
  const int reach = static_cast<int>(std::ceil(reach_m / frame.cell_m));
  std::optional<Eigen::Vector2i> nearest;
  int least = std::numeric_limits<int>::max();
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      const Eigen::Vector2i cell = center + Eigen::Vector2i(x, y);
      const int distance2 = x * x + y * y;
      if (distance2 >= least || distance2 > reach * reach || !belief.Contains(cell)) continue;
      if (belief.At(cell) != Cell::kFree) continue;
      least = distance2;
      nearest = cell;
    }
  }
  return nearest;
}

double FreeArea(const OccupancyGrid& map, const Bounds& bounds) {
  int cells = 0;
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      cells += KindOf(map.At(x, y)) == Cell::kFree && bounds.Contains(map.CenterOf({x, y}));
    }
  }
  return cells * map.resolution_m * map.resolution_m;
}

}  // namespace hv::explore
