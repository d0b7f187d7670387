#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "hv_explore_sac/belief.h"
#include "hv_explore_sac/exploration_config.h"

namespace hv::explore {

/// The border between what is known to be free and what is unknown. The belief is summed up in
/// blocks (occupied if one cell is, else unknown if one cell is, else free); a free block with some
/// unknown ones around it is a frontier point, named by the index of the block and located at its
/// first cell. Blocks begin at the lowest cell of the belief. Not thread-safe.
class Frontiers {
 public:
  Frontiers(const FrontierConfig& config, const Belief& belief);

  /// Takes over `belief.changes()`.
  void Update(const Belief& belief);

  /// All frontier points, in no particular order.
  const std::vector<int>& points() const { return points_; }
  /// What the last update added and removed.
  const std::vector<int>& added() const { return added_; }
  const std::vector<int>& removed() const { return removed_; }

  int block() const { return block_; }  ///< edge of a block [cells]
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// How many cells of a block are unknown.
  int UnknownIn(int block) const { return unknown_cells_[static_cast<std::size_t>(block)]; }

  bool IsFrontier(int point) const { return place_[static_cast<std::size_t>(point)] >= 0; }
  Eigen::Vector2i CellOf(int point) const {
    return low_ + block_ * Eigen::Vector2i(point % columns_, point / columns_);
  }

  /// Mean of the points [cells]; zero when there is none.
  Eigen::Vector2d Centroid() const;

 private:
  enum class Block { kFree, kUnknown, kOccupied };
  Block KindOf(std::size_t block) const;
  int BlockOf(const Belief& belief, int cell) const;
  void Recount(const Belief& belief, const Belief::CellChange& change);
  template <typename Visit>
  void AroundBlock(int block, Visit visit) const;
  void Touch(int block);
  void Judge(int block);
  void Insert(int block);
  void Erase(int block);

  FrontierConfig config_;
  int block_;
  Eigen::Vector2i low_;
  int columns_;
  int rows_;
  std::vector<std::int16_t> unknown_cells_;   ///< of each block
  std::vector<std::int16_t> occupied_cells_;  ///< of each block
  std::vector<std::uint8_t> unknown_around_;  ///< unknown blocks of the eight around
  std::vector<std::uint8_t> touched_mark_;
  std::vector<int> touched_;  ///< blocks to be judged anew
  std::vector<int> place_;    ///< of a block in `points_`, or -1
  std::vector<int> points_;
  std::vector<int> added_;
  std::vector<int> removed_;
};

}  // namespace hv::explore
