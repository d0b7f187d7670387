#include "hv_replay/goal_sampler.h"

#include <cmath>
#include <vector>

#include "hv_navigation/grid_search.h"

namespace hv::replay {
namespace {

using Eigen::Vector2i;
using navigation::ClearanceGrid;
using navigation::GridSearch;

constexpr double kAway_m = 1.0;  ///< of places with room to turn from the start

}  // namespace

GoalSampler::GoalSampler(const OccupancyGrid& map, const navigation::Footprint& footprint,
                         std::uint32_t seed)
    : map_(map, ClearanceGrid::Unknown::kOccupied, footprint.CircumscribedRadius() + 1.0),
      inscribed_m_(footprint.InscribedRadius()),
      circumscribed_m_(footprint.CircumscribedRadius()),
      random_({seed, 0x60A1U}) {}

std::optional<Vector2i> GoalSampler::OpenCellNear(const Eigen::Vector2d& position) const {
  const Vector2i center = map_.CellOf(position);
  const int reach = static_cast<int>(kAway_m / map_.grid().resolution_m);
  std::optional<Vector2i> nearest;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      const Vector2i cell = center + Vector2i(x, y);
      if (map_.ClearanceAt(cell) < circumscribed_m_) continue;
      const bool nearer =
          !nearest || (cell - center).squaredNorm() < (*nearest - center).squaredNorm();
      if (nearer) nearest = cell;
    }
  }
  return nearest;
}

double GoalSampler::OptimalLength(const Vector2i& start, const Vector2i& goal) const {
  GridSearch search(map_);
  const auto fits = [this](const Vector2i& cell) {
    return map_.ClearanceAt(cell) >= inscribed_m_ ? 1.0 : 0.0;
  };
  search.Run(start, goal, fits);
  return navigation::RouteLength(search.RouteTo(goal), map_.grid().resolution_m);
}

std::optional<GoalSampler::Goal> GoalSampler::Next(const navigation::PlanarPose& start,
                                                   double least_m) {
  const std::optional<Vector2i> from = OpenCellNear(start.position);
  if (!from) return std::nullopt;
  GridSearch search(map_);
  search.Flood(*from, [this](const Vector2i& cell) {
    return map_.ClearanceAt(cell) >= circumscribed_m_ ? 1.0 : 0.0;
  });
  // The border of an obstacle is known to a cell.
  const double cell_m = map_.grid().resolution_m;
  std::vector<Vector2i> cells;
  for (int y = 0; y < map_.grid().height; ++y) {
    for (int x = 0; x < map_.grid().width; ++x) {
      const bool far = (map_.CenterOf({x, y}) - start.position).norm() >= least_m;
      const bool roomy = map_.ClearanceAt(Vector2i(x, y)) >= circumscribed_m_ + cell_m;
      if (far && roomy && search.Reached({x, y})) cells.emplace_back(x, y);
    }
  }
  if (cells.empty()) return std::nullopt;
  const Vector2i cell =
      cells[static_cast<std::size_t>(random_.Uniform(0.0, static_cast<double>(cells.size())))];
  return Goal{{map_.CenterOf(cell), random_.Uniform(-M_PI, M_PI)}, OptimalLength(*from, cell)};
}

}  // namespace hv::replay
