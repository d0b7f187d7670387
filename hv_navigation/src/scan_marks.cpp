#include "scan_marks.h"

#include <algorithm>
#include <cmath>

#include "voxel_ray.h"

namespace hv::navigation {
namespace {

/// The three bits of a coordinate within a block, two apart.
constexpr std::array<std::size_t, 8> kSpread = {0, 1, 8, 9, 64, 65, 72, 73};

ScanMarks::Mark SlicesBetween(double a, double b) {
  const auto slice = [](double height) {
    const int k = static_cast<int>(height * ScanMarks::kSlices);
    return std::max(0, std::min(ScanMarks::kSlices - 1, k));
  };
  const int low = slice(std::min(a, b));
  const int high = slice(std::max(a, b));
  return static_cast<ScanMarks::Mark>((2 << high) - (1 << low));
}

}  // namespace

void ScanMarks::SetBox(const Eigen::Vector3i& low_block, const Eigen::Vector3i& blocks) {
  Restart();
  low_block_ = low_block;
  low_cell_ = low_block * kBlockSide;
  if (blocks == blocks_) return;
  blocks_ = blocks;
  touched_.assign(static_cast<std::size_t>(blocks.prod()), 0);
  marks_.assign(touched_.size() * kBlockVoxels, 0);
}

void ScanMarks::Restart() {
  for (std::size_t block = 0; block < touched_.size(); ++block) {
    if (touched_[block] == 0) continue;
    std::fill_n(&marks_[block * kBlockVoxels], kBlockVoxels, Mark{0});
    touched_[block] = 0;
  }
  hits_.clear();
}

bool ScanMarks::Contains(const Eigen::Vector3d& point) const {
  const Eigen::Array3d inside = point.array() - low_cell_.cast<double>().array();
  return (inside >= 0.0).all() && (inside < (blocks_ * kBlockSide).cast<double>().array()).all();
}

std::size_t ScanMarks::Index(const Eigen::Vector3i& cell) const {
  const Eigen::Vector3i inside = cell - low_cell_;
  const auto block = static_cast<std::size_t>(
      ((inside.z() >> 3) * blocks_.y() + (inside.y() >> 3)) * blocks_.x() + (inside.x() >> 3));
  return block * kBlockVoxels + kSpread[static_cast<std::size_t>(inside.x() & 7)] +
         2 * kSpread[static_cast<std::size_t>(inside.y() & 7)] +
         4 * kSpread[static_cast<std::size_t>(inside.z() & 7)];
}

Eigen::Vector3i ScanMarks::BlockAt(std::size_t block) const {
  const auto index = static_cast<int>(block);
  return low_block_ + Eigen::Vector3i(index % blocks_.x(), index / blocks_.x() % blocks_.y(),
                                      index / (blocks_.x() * blocks_.y()));
}

Eigen::Vector3i ScanMarks::CellAt(std::size_t index) const {
  const auto place = static_cast<int>(index % kBlockVoxels);
  const auto gather = [](int bits) { return (bits & 1) | ((bits >> 2) & 2) | ((bits >> 4) & 4); };
  return BlockAt(index / kBlockVoxels) * kBlockSide +
         Eigen::Vector3i(gather(place), gather(place >> 1), gather(place >> 2));
}

void ScanMarks::AddHit(const Eigen::Vector3d& point) {
  const Eigen::Vector3i cell = point.array().floor().cast<int>();
  const std::size_t index = Index(cell);
  marks_[index] = static_cast<Mark>(marks_[index] | kHit);
  touched_[index / kBlockVoxels] = 1;
  const auto z = static_cast<float>(point.z());
  hits_.push_back({static_cast<std::uint32_t>(index), z, z});
}

void ScanMarks::AddRay(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d way = to - from;
  double share = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    constexpr double kInside = 1e-6;
    const double low = low_cell_[axis] + kInside;
    const double high = low_cell_[axis] + blocks_[axis] * kBlockSide - kInside;
    if (to[axis] < low) share = std::min(share, (low - from[axis]) / way[axis]);
    if (to[axis] > high) share = std::min(share, (high - from[axis]) / way[axis]);
  }
  const Eigen::Vector3d end = from + std::max(0.0, share) * way;
  Mark& end_mark = marks_[Index(end.array().floor().cast<int>())];
  if ((end_mark & kRayEnd) != 0) return;
  end_mark = static_cast<Mark>(end_mark | kRayEnd);
  touched_[IndexOf(&end_mark) / kBlockVoxels] = 1;
  const double rise = end.z() - from.z();
  TraverseVoxels(from, end, [&](const Eigen::Vector3i& cell, double enter, double leave) {
    const double height = from.z() - cell.z();
    const std::size_t index = Index(cell);
    marks_[index] = static_cast<Mark>(marks_[index] |
                                      SlicesBetween(height + enter * rise, height + leave * rise));
    touched_[index / kBlockVoxels] = 1;
  });
}

void ScanMarks::Finish() {
  std::sort(hits_.begin(), hits_.end(), [](const Hit& a, const Hit& b) {
    return a.voxel != b.voxel ? a.voxel < b.voxel : a.low < b.low;
  });
  std::size_t kept = 0;
  for (const Hit& hit : hits_) {
    if (kept > 0 && hits_[kept - 1].voxel == hit.voxel) {
      hits_[kept - 1].high = std::max(hits_[kept - 1].high, hit.high);
    } else {
      hits_[kept++] = hit;
    }
  }
  hits_.resize(kept);
}

const ScanMarks::Hit& ScanMarks::HitAt(std::size_t voxel) const {
  return *std::lower_bound(hits_.begin(), hits_.end(), voxel,
                           [](const Hit& hit, std::size_t index) { return hit.voxel < index; });
}

}  // namespace hv::navigation
