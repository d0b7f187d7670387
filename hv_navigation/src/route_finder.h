#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "free_space.h"
#include "hv_navigation/grid_search.h"

namespace hv::navigation {

using Route = std::vector<Eigen::Vector2i>;  ///< neighbouring cells

/// Seeks routes over the cells of a grid that are wide enough for the inscribed circle. Holds
/// references. Not thread-safe.
class RouteFinder {
 public:
  explicit RouteFinder(const FreeSpace& space) : space_(space), search_(space.grid()) {}

  /// Seeks the shortest route. The goal counts as wide enough. When there is none, Reached() tells
  /// what the start is connected with.
  bool Connect(const Eigen::Vector2i& start, const Eigen::Vector2i& goal);
  bool Reached(const Eigen::Vector2i& cell) const { return search_.Reached(cell); }
  /// Makes the route to a cell that was reached the shortest one, from which the others follow.
  void Take(const Eigen::Vector2i& goal);
  const Route& shortest() const { return shortest_; }

  /// Near the shortest one, but away from obstacles as far as `space` makes nearness cost.
  Route Roomy(const FreeSpace& space);

  /// The same anywhere but where it is closed; empty when there is none.
  Route Open(const FreeSpace& space);
  /// Closes what is narrow about a stretch where the robot does not get through.
  void Close(const Route& stretch);

 private:
  bool IsWide(const Eigen::Vector2i& cell) const;
  std::vector<std::uint8_t> BandMask() const;
  /// The cheapest route over cells that `allowed(cell)`, from the shortest one's start to its end.
  template <typename Allowed>
  Route Cheapest(const FreeSpace& space, const Allowed& allowed);
  std::size_t IndexOf(const Eigen::Vector2i& cell) const;

  const FreeSpace& space_;
  GridSearch search_;
  Route shortest_;
  std::vector<std::uint8_t> closed_;  ///< 1: closed; empty: nothing is
};

}  // namespace hv::navigation
