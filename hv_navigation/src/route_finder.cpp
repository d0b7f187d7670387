#include "route_finder.h"

#include <algorithm>
#include <cmath>

namespace hv::navigation {
namespace {

constexpr double kBand_m = 1.5;   // about the shortest route, for the one with room
constexpr double kAbout_m = 0.3;  // about a narrow stretch

}  // namespace

bool RouteFinder::IsWide(const Eigen::Vector2i& cell) const {
  const double needed_m = space_.NeededClearance(space_.grid().CenterOf(cell));
  return space_.grid().ClearanceAt(cell) >= needed_m;
}

std::size_t RouteFinder::IndexOf(const Eigen::Vector2i& cell) const {
  return static_cast<std::size_t>(cell.y()) * static_cast<std::size_t>(space_.grid().grid().width) +
         static_cast<std::size_t>(cell.x());
}

bool RouteFinder::Connect(const Eigen::Vector2i& start, const Eigen::Vector2i& goal) {
  return search_.Run(start, goal, [&](const Eigen::Vector2i& cell) {
    return cell == goal || IsWide(cell) ? 1.0 : 0.0;
  });
}

void RouteFinder::Take(const Eigen::Vector2i& goal) { shortest_ = search_.RouteTo(goal); }

template <typename Allowed>
Route RouteFinder::Cheapest(const FreeSpace& space, const Allowed& allowed) {
  const Eigen::Vector2i goal = shortest_.back();
  const auto factor = [&](const Eigen::Vector2i& cell) {
    if (!allowed(cell) || (cell != goal && !IsWide(cell))) return 0.0;
    return 1.0 + space.Nearness(space.grid().ClearanceAt(cell));
  };
  return search_.Run(shortest_.front(), goal, factor) ? search_.RouteTo(goal) : Route();
}

std::vector<std::uint8_t> RouteFinder::BandMask() const {
  const OccupancyGrid& cells = space_.grid().grid();
  std::vector<std::uint8_t> mask(cells.cells.size(), 0);
  const int radius = static_cast<int>(std::ceil(kBand_m / cells.resolution_m));
  for (std::size_t i = 0; i < shortest_.size(); ++i) {
    const bool stamp = i % static_cast<std::size_t>(std::max(1, radius / 4)) == 0;
    if (!stamp && i + 1 != shortest_.size()) continue;
    const Eigen::Vector2i low = (shortest_[i].array() - radius).max(0);
    const Eigen::Vector2i high =
        (shortest_[i].array() + radius).min(Eigen::Array2i(cells.width, cells.height) - 1);
    for (int y = low.y(); y <= high.y(); ++y) {
      const auto row = mask.begin() + static_cast<std::ptrdiff_t>(y) * cells.width;
      std::fill(row + low.x(), row + high.x() + 1, std::uint8_t{1});
    }
  }
  return mask;
}

Route RouteFinder::Roomy(const FreeSpace& space) {
  const std::vector<std::uint8_t> mask = BandMask();
  Route route =
      Cheapest(space, [&](const Eigen::Vector2i& cell) { return mask[IndexOf(cell)] != 0; });
  return route.empty() ? shortest_ : route;
}

Route RouteFinder::Open(const FreeSpace& space) {
  return Cheapest(space, [this](const Eigen::Vector2i& cell) {
    return closed_.empty() || closed_[IndexOf(cell)] == 0;
  });
}

void RouteFinder::Close(const Route& stretch) {
  const ClearanceGrid& grid = space_.grid();
  closed_.resize(grid.grid().cells.size(), 0);
  const int radius = static_cast<int>(std::ceil(kAbout_m / grid.grid().resolution_m));
  for (const Eigen::Vector2i& middle : stretch) {
    for (int y = -radius; y <= radius; ++y) {
      for (int x = -radius; x <= radius; ++x) {
        const Eigen::Vector2i cell = middle + Eigen::Vector2i(x, y);
        const bool narrow =
            grid.Contains(cell) && grid.ClearanceAt(cell) < space_.circumscribed_m();
        if (narrow) closed_[IndexOf(cell)] = 1;
      }
    }
  }
}

}  // namespace hv::navigation
