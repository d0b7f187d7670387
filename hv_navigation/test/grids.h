#pragma once

#include <cmath>
#include <limits>
#include <queue>
#include <random>
#include <utility>
#include <vector>

#include "hv_navigation/clearance_grid.h"

namespace hv::navigation {

inline OccupancyGrid EmptyCells(int width, int height, double resolution_m) {
  OccupancyGrid grid;
  grid.resolution_m = resolution_m;
  grid.width = width;
  grid.height = height;
  grid.cells.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                    OccupancyGrid::kFree);
  return grid;
}

/// Makes the cells whose centres lie in the rectangle `value`.
inline void FillCells(OccupancyGrid& grid, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                      std::int8_t value = OccupancyGrid::kOccupied) {
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      const Eigen::Vector2d center =
          grid.origin + grid.resolution_m * Eigen::Vector2d(column + 0.5, row + 0.5);
      if ((center.array() >= low.array()).all() && (center.array() <= high.array()).all()) {
        grid.At(column, row) = value;
      }
    }
  }
}

/// Walls all around.
inline void FenceCells(OccupancyGrid& grid) {
  const Eigen::Vector2d size = grid.resolution_m * Eigen::Vector2d(grid.width, grid.height);
  const double cell_m = grid.resolution_m;
  const Eigen::Vector2d far = grid.origin + size;
  FillCells(grid, grid.origin, {far.x(), grid.origin.y() + cell_m});
  FillCells(grid, grid.origin, {grid.origin.x() + cell_m, far.y()});
  FillCells(grid, {grid.origin.x(), far.y() - cell_m}, far);
  FillCells(grid, {far.x() - cell_m, grid.origin.y()}, far);
}

/// Single cells are occupied at random.
inline OccupancyGrid RandomCells(int width, int height, double occupied, unsigned seed) {
  OccupancyGrid grid = EmptyCells(width, height, 0.1);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform;
  for (std::int8_t& cell : grid.cells) {
    if (uniform(random) < occupied) cell = OccupancyGrid::kOccupied;
  }
  return grid;
}

/// A fenced room with boxes of 0.2 to 1.5 m at random.
inline OccupancyGrid RandomRoom(double size_m, int boxes, double resolution_m, unsigned seed) {
  const int cells = static_cast<int>(std::lround(size_m / resolution_m));
  OccupancyGrid grid = EmptyCells(cells, cells, resolution_m);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(0.0, size_m);
  std::uniform_real_distribution<double> edge(0.2, 1.5);
  for (int i = 0; i < boxes; ++i) {
    const Eigen::Vector2d low(place(random), place(random));
    const Eigen::Vector2d size(edge(random), edge(random));
    FillCells(grid, low, low + size);
  }
  FenceCells(grid);
  return grid;
}

inline std::size_t CellIndex(const ClearanceGrid& grid, const Eigen::Vector2i& cell) {
  return static_cast<std::size_t>(cell.y()) * static_cast<std::size_t>(grid.grid().width) +
         static_cast<std::size_t>(cell.x());
}

/// A random cell that keeps `clearance_m`.
inline Eigen::Vector2i OpenCell(const ClearanceGrid& grid, double clearance_m, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> column(0, grid.grid().width - 1);
  std::uniform_int_distribution<int> row(0, grid.grid().height - 1);
  while (true) {
    const Eigen::Vector2i cell(column(random), row(random));
    if (grid.ClearanceAt(cell) >= clearance_m) return cell;
  }
}

/// Shortest 8-connected lengths from `start` over cells that keep `clearance_m`; infinite where no
/// way leads [m].
inline std::vector<double> DijkstraLengths(const ClearanceGrid& grid, double clearance_m,
                                           const Eigen::Vector2i& start) {
  std::vector<double> lengths(grid.grid().cells.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, std::pair<int, int>>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  lengths[CellIndex(grid, start)] = 0.0;
  open.push({0.0, {start.x(), start.y()}});
  while (!open.empty()) {
    const auto [length, place] = open.top();
    open.pop();
    const Eigen::Vector2i cell(place.first, place.second);
    if (length > lengths[CellIndex(grid, cell)]) continue;
    for (int i = 0; i < 9; ++i) {
      const Eigen::Vector2i step(i % 3 - 1, i / 3 - 1);
      const Eigen::Vector2i next = cell + step;
      if (!grid.Contains(next) || grid.ClearanceAt(next) < clearance_m) continue;
      const double total = length + step.cast<double>().norm() * grid.grid().resolution_m;
      if (total >= lengths[CellIndex(grid, next)]) continue;
      lengths[CellIndex(grid, next)] = total;
      open.push({total, {next.x(), next.y()}});
    }
  }
  return lengths;
}

}  // namespace hv::navigation
