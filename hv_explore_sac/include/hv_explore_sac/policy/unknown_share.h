#pragma once

#include <vector>

#include <Eigen/Core>

#include "hv_explore_sac/frontiers.h"

namespace hv::explore {

/// How much around a place is unknown, in squares of any size: sums over squares of the blocks in
/// which the frontiers count what is unknown. Nothing beyond the belief is. Not thread-safe.
class UnknownShare {
 public:
  /// `edge`: of the squares [blocks of the frontiers].
  void Count(const Frontiers& frontiers, int edge);

  /// Share of the square with the edge 2 x `reach` around `cell` [cells], which may lie outside.
  float Around(const Eigen::Vector2f& cell, float reach) const;
  float Everywhere() const;

 private:
  int SumUpTo(int column, int row) const {
    return sums_[static_cast<std::size_t>(row * (columns_ + 1) + column)];
  }

  int square_ = 1;  ///< edge [cells]
  int columns_ = 0;
  int rows_ = 0;
  std::vector<int> sums_;  ///< over all squares with a smaller row and column
};

}  // namespace hv::explore
