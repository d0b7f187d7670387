#include "hv_navigation/surface_columns.h"

#include <algorithm>
#include <cmath>

namespace hv::navigation {
namespace {

constexpr int kLevels = 64;
constexpr int kLevelsBelow = 13;

/// Bits from `low` to below `high`.
std::uint64_t Bits(int low, int high) {
  const auto below = [](int count) {
    const int bits = std::max(0, std::min(kLevels, count));
    return bits == kLevels ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
  };
  return below(high) & ~below(low);
}

}  // namespace

SurfaceColumns::SurfaceColumns(const ObstacleMap& map, const Eigen::Vector3d& middle, double side_m)
    : voxel_m_(map.voxel_m()),
      side_(2 * static_cast<int>(std::ceil(0.5 * side_m / voxel_m_)) + 1),
      low_(map.VoxelOf(middle) - Eigen::Vector3i(side_ / 2, side_ / 2, kLevelsBelow)),
      free_(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_), 0) {
  std::vector<Placed> placed;
  map.Visit(low_, low_ + Eigen::Vector3i(side_, side_, kLevels), [&](const VoxelView& voxel) {
    if (voxel.occupied) {
      AddOccupied(voxel, placed);
    } else {
      AddFree(voxel);
    }
  });
  Sort(placed);
}

void SurfaceColumns::AddFree(const VoxelView& voxel) {
  const Eigen::Vector3i low = voxel.low - low_;
  const std::uint64_t bits = Bits(low.z(), low.z() + voxel.side);
  for (int y = std::max(0, low.y()); y < std::min(side_, low.y() + voxel.side); ++y) {
    for (int x = std::max(0, low.x()); x < std::min(side_, low.x() + voxel.side); ++x) {
      free_[Index({x, y})] |= bits;
    }
  }
}

void SurfaceColumns::AddOccupied(const VoxelView& voxel, std::vector<Placed>& placed) const {
  const Eigen::Vector3i low = voxel.low - low_;
  for (int y = std::max(0, low.y()); y < std::min(side_, low.y() + voxel.side); ++y) {
    for (int x = std::max(0, low.x()); x < std::min(side_, low.x() + voxel.side); ++x) {
      placed.push_back({Index({x, y}), {voxel.low_m, voxel.high_m}});
    }
  }
}

void SurfaceColumns::Sort(const std::vector<Placed>& placed) {
  begin_.assign(free_.size() + 1, 0);
  for (const Placed& one : placed) ++begin_[one.column + 1];
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  surfaces_.resize(placed.size());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (const Placed& one : placed) surfaces_[next[one.column]++] = one.surface;
  for (std::size_t i = 0; i + 1 < begin_.size(); ++i) {
    std::sort(surfaces_.begin() + begin_[i], surfaces_.begin() + begin_[i + 1],
              [](const Surface& a, const Surface& b) { return a.low < b.low; });
  }
}

bool SurfaceColumns::FreeBetween(std::size_t index, double low_m, double high_m) const {
  const auto level = [&](double height_m) {
    const double levels = std::ceil(height_m / voxel_m_ - 0.5 - low_.z() - 1e-6);
    return static_cast<int>(std::max(-1.0, std::min(1.0 + kLevels, levels)));
  };
  return (free_[index] & Bits(level(low_m), level(high_m))) != 0;
}

}  // namespace hv::navigation
