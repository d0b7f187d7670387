#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "hv_navigation/clearance_grid.h"

namespace hv::navigation {

/// A* over the eight neighbours of a cell. Not thread-safe.
class GridSearch {
 public:
  /// What a cell costs: 0 = closed, 1 = its length, more = that many times its length, up to
  /// kMaxFactor.
  using CellFactor = std::function<double(const Eigen::Vector2i&)>;
  static constexpr double kMaxFactor = 8.0;

  explicit GridSearch(const ClearanceGrid& grid);

  /// Searches the cheapest way. When there is none, every cell that `start` reaches has been
  /// reached. Both must lie in the grid; `start` counts as open.
  bool Run(const Eigen::Vector2i& start, const Eigen::Vector2i& goal, const CellFactor& factor);

  /// Reaches all that `start` is connected with.
  void Flood(const Eigen::Vector2i& start, const CellFactor& factor);

  bool Reached(const Eigen::Vector2i& cell) const;

  /// Cost of the way to a cell that was reached, in metres of cells that cost their length [m].
  double CostTo(const Eigen::Vector2i& cell) const;

  /// Cells from the start of the last run to `cell`, which must have been reached.
  std::vector<Eigen::Vector2i> RouteTo(const Eigen::Vector2i& cell) const;

 private:
  int IndexOf(const Eigen::Vector2i& cell) const { return cell.y() * width_ + cell.x(); }
  Eigen::Vector2i CellOf(int index) const { return {index % width_, index / width_}; }
  int Heuristic(const Eigen::Vector2i& cell) const;
  void Push(const Eigen::Vector2i& cell, int cost, std::uint8_t came_by);
  void Expand(int index, const CellFactor& factor);
  void Clear();
  bool Search(const Eigen::Vector2i& start, const CellFactor& factor);

  const ClearanceGrid& grid_;
  int width_;
  std::optional<Eigen::Vector2i> goal_;
  std::vector<int> cost_;               ///< from the start, in units of the search
  std::vector<std::uint8_t> came_by_;   ///< direction of the last step
  std::vector<std::vector<int>> open_;  ///< cells by estimate, in a ring
  int estimate_ = 0;                    ///< smallest that may be open
  int waiting_ = 0;                     ///< entries of `open_`
};

/// Length of a chain of neighbouring cells [m].
double RouteLength(const std::vector<Eigen::Vector2i>& route, double resolution_m);

}  // namespace hv::navigation
