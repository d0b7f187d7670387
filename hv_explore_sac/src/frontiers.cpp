#include "hv_explore_sac/frontiers.h"

#include <algorithm>

namespace hv::explore {
namespace {

int BlocksFor(int cells, int block) { return (cells + block - 1) / block; }

}  // namespace

template <typename Visit>
void Frontiers::AroundBlock(int block, Visit visit) const {
  const int column = block % columns_;
  const int row = block / columns_;
  for (int y = std::max(0, row - 1); y <= std::min(rows_ - 1, row + 1); ++y) {
    for (int x = std::max(0, column - 1); x <= std::min(columns_ - 1, column + 1); ++x) {
      const int other = y * columns_ + x;
      if (other != block) visit(other);
    }
  }
}

Frontiers::Frontiers(const FrontierConfig& config, const Belief& belief)
    : config_(config),
      block_(config.block),
      low_(belief.low()),
      columns_(BlocksFor(belief.width(), block_)),
      rows_(BlocksFor(belief.height(), block_)) {
  const auto blocks = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  unknown_cells_.assign(blocks, 0);
  occupied_cells_.assign(blocks, 0);
  unknown_around_.assign(blocks, 0);
  touched_mark_.assign(blocks, 0);
  place_.assign(blocks, -1);
  for (int cell = 0; cell < belief.width() * belief.height(); ++cell) {
    const auto block = static_cast<std::size_t>(BlockOf(belief, cell));
    unknown_cells_[block] += belief.At(cell) == Cell::kUnknown;
    occupied_cells_[block] += belief.At(cell) == Cell::kOccupied;
  }
  for (int block = 0; block < columns_ * rows_; ++block) {
    if (KindOf(static_cast<std::size_t>(block)) != Block::kUnknown) continue;
    AroundBlock(block, [&](int other) { ++unknown_around_[static_cast<std::size_t>(other)]; });
  }
  for (int block = 0; block < columns_ * rows_; ++block) Judge(block);
}

void Frontiers::Update(const Belief& belief) {
  added_.clear();
  removed_.clear();
  for (const Belief::CellChange& change : belief.changes()) Recount(belief, change);
  for (const int block : touched_) {
    touched_mark_[static_cast<std::size_t>(block)] = 0;
    Judge(block);
  }
  touched_.clear();
}

Eigen::Vector2d Frontiers::Centroid() const {
  if (points_.empty()) return Eigen::Vector2d::Zero();
  Eigen::Matrix<std::int64_t, 2, 1> sum(0, 0);
  for (const int point : points_) sum += CellOf(point).cast<std::int64_t>();
  return sum.cast<double>() / static_cast<double>(points_.size());
}

Frontiers::Block Frontiers::KindOf(std::size_t block) const {
  if (occupied_cells_[block] > 0) return Block::kOccupied;
  return unknown_cells_[block] > 0 ? Block::kUnknown : Block::kFree;
}

int Frontiers::BlockOf(const Belief& belief, int cell) const {
  const Eigen::Vector2i place = (belief.CellOf(cell) - low_) / block_;
  return place.y() * columns_ + place.x();
}

void Frontiers::Recount(const Belief& belief, const Belief::CellChange& change) {
  const int block = BlockOf(belief, change.index);
  const auto index = static_cast<std::size_t>(block);
  const Block before = KindOf(index);
  const auto count = [&](Cell cell, int by) {
    if (cell == Cell::kFree) return;
    auto& cells = cell == Cell::kUnknown ? unknown_cells_ : occupied_cells_;
    cells[index] = static_cast<std::int16_t>(cells[index] + by);
  };
  count(change.before, -1);
  count(change.after, 1);
  const Block after = KindOf(index);
  if (before == after) return;
  Touch(block);
  if (before != Block::kUnknown && after != Block::kUnknown) return;
  AroundBlock(block, [&](int other) {
    std::uint8_t& unknown = unknown_around_[static_cast<std::size_t>(other)];
    unknown = static_cast<std::uint8_t>(after == Block::kUnknown ? unknown + 1 : unknown - 1);
    Touch(other);
  });
}

void Frontiers::Touch(int block) {
  std::uint8_t& mark = touched_mark_[static_cast<std::size_t>(block)];
  if (mark != 0) return;
  mark = 1;
  touched_.push_back(block);
}

void Frontiers::Judge(int block) {
  const auto index = static_cast<std::size_t>(block);
  const int unknown = unknown_around_[index];
  const bool frontier = KindOf(index) == Block::kFree && unknown >= config_.min_unknown &&
                        unknown <= config_.max_unknown;
  if (frontier == IsFrontier(block)) return;
  if (frontier) {
    Insert(block);
  } else {
    Erase(block);
  }
}

void Frontiers::Insert(int block) {
  place_[static_cast<std::size_t>(block)] = static_cast<int>(points_.size());
  points_.push_back(block);
  added_.push_back(block);
}

void Frontiers::Erase(int block) {
  const int place = place_[static_cast<std::size_t>(block)];
  const int last = points_.back();
  points_[static_cast<std::size_t>(place)] = last;
  place_[static_cast<std::size_t>(last)] = place;
  place_[static_cast<std::size_t>(block)] = -1;
  points_.pop_back();
  removed_.push_back(block);
}

}  // namespace hv::explore
