#include "voxel_space.h"

#include <algorithm>
#include <limits>

#include <Eigen/Eigenvalues>

namespace hv::loop {
namespace {

constexpr int kHalfRange = 1 << 20;
/// A ray sees through a surface only when it ends this many voxels behind it.
constexpr double kBehind = 3.0;
/// And passes its mean point within this many voxels.
constexpr double kBeside = 0.5;
/// Least sine of the angle between ray and plane, in flat surroundings.
constexpr double kLeastCrossing = 0.17;
/// How far behind the plane such a ray must end, in voxels.
constexpr double kBehindPlane = 1.5;

std::size_t BitOf(const VoxelIndex& voxel) {
  constexpr int kMask = Block::kSide - 1;
  return Block::Bit(voxel.x() & kMask, voxel.y() & kMask, voxel.z() & kMask);
}

void Increment(std::uint16_t& count) {
  if (count < std::numeric_limits<std::uint16_t>::max()) ++count;
}

}  // namespace

struct VoxelSpace::Ray {
  std::uint32_t scan = 0;
  Eigen::Vector3d origin;
  Eigen::Vector3d end;
  Eigen::Vector3d direction;  // unit
  double range = 0.0;
};

bool VoxelSpace::IndexOf(const Eigen::Vector3d& position, VoxelIndex& voxel) const {
  const Eigen::Array3d index = (position.array() / voxel_m_).floor();
  if (!(index.abs() < kHalfRange - 2.0).all()) return false;
  voxel = index.cast<int>();
  return true;
}

void VoxelSpace::AddHits(std::uint32_t scan, const std::vector<MapPoint>& points) {
  for (const MapPoint& point : points) {
    VoxelIndex voxel;
    if (!IndexOf(point.position, voxel)) continue;
    const auto [entry, is_new] =
        surface_of_voxel_.emplace(KeyOf(voxel), static_cast<std::uint32_t>(surfaces_.size()));
    if (is_new) {
      surfaces_.emplace_back().voxel = voxel;
      BlockOf(voxel).hit.set(BitOf(voxel));
    }
    Surface& surface = surfaces_[entry->second];
    surface.offset_sum += (point.position - voxel.cast<double>() * voxel_m_).cast<float>();
    surface.intensity_sum += point.intensity;
    surface.points += 1.0F;
    if (surface.hit_scan != scan) Increment(surface.hits);
    surface.hit_scan = scan;
  }
}

void VoxelSpace::FindNormals() {
  for (Surface& surface : surfaces_) {
    surface.normal = NormalAt(surface);
    surface.hit_scan = 0;
  }
}

/// Plane through the mean points of the 27 voxels around.
Eigen::Vector3f VoxelSpace::NormalAt(const Surface& surface) {
  constexpr double kLeastPoints = 5.0;
  constexpr double kFlat = 0.2;    // largest standard deviation across the plane, in voxels
  constexpr double kSpread = 0.5;  // least one along it
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d outer = Eigen::Matrix3d::Zero();
  double count = 0.0;
  for (int i = 0; i < 27; ++i) {
    const VoxelIndex step(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    const Surface* near = Find(surface.voxel + step);
    if (near == nullptr) continue;
    const Eigen::Vector3d offset =
        step.cast<double>() + (near->offset_sum / near->points).cast<double>() / voxel_m_;
    sum += offset;
    outer += offset * offset.transpose();
    count += 1.0;
  }
  if (count < kLeastPoints) return Eigen::Vector3f::Zero();
  const Eigen::Vector3d mean = sum / count;
  const Eigen::Matrix3d covariance = outer / count - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  const Eigen::Vector3d deviation = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  if (deviation[0] > kFlat || deviation[1] < kSpread) return Eigen::Vector3f::Zero();
  return solver.eigenvectors().col(0).cast<float>();
}

void VoxelSpace::CastRays(std::uint32_t scan, const Eigen::Vector3d& origin,
                          const std::vector<MapPoint>& points) {
  VoxelIndex voxel;
  if (!IndexOf(origin, voxel)) return;
  for (const MapPoint& point : points) {
    Surface* surface = IndexOf(point.position, voxel) ? Find(voxel) : nullptr;
    if (surface != nullptr) surface->hit_scan = scan;
  }
  for (const MapPoint& point : points) {
    Ray ray{scan, origin, point.position, point.position - origin, 0.0};
    ray.range = ray.direction.norm();
    if (!(ray.range > voxel_m_) || !IndexOf(point.position, voxel)) continue;
    ray.direction /= ray.range;
    CastRay(ray, voxel);
  }
}

void VoxelSpace::CastRay(const Ray& ray, const VoxelIndex& last) {
  const double length = std::min(ray.range, max_ray_m_);
  WalkVoxels(ray.origin, ray.origin + length * ray.direction, voxel_m_,
             [this, &ray, &last](const VoxelIndex& voxel) {
               if (voxel == last) return false;
               Pass(ray, voxel);
               return true;
             });
}

void VoxelSpace::Pass(const Ray& ray, const VoxelIndex& voxel) {
  Block& block = BlockOf(voxel);
  const std::size_t bit = BitOf(voxel);
  block.free.set(bit);
  if (!block.hit.test(bit)) return;
  Surface& surface = *Find(voxel);
  if (surface.hit_scan == ray.scan || surface.miss_scan == ray.scan) return;
  if (!SeesThrough(ray, surface)) return;
  Increment(surface.misses);
  surface.miss_scan = ray.scan;
}

bool VoxelSpace::SeesThrough(const Ray& ray, const Surface& surface) const {
  const Eigen::Vector3d mean = MeanOf(surface);
  const Eigen::Vector3d from_origin = mean - ray.origin;
  const double along = from_origin.dot(ray.direction);
  if (ray.range - along < kBehind * voxel_m_) return false;
  if ((from_origin - along * ray.direction).norm() > kBeside * voxel_m_) return false;
  const Eigen::Vector3d normal = surface.normal.cast<double>();
  if (normal.isZero()) return true;
  const double crossing = normal.dot(ray.direction);
  const double behind = normal.dot(ray.end - mean) * (crossing > 0.0 ? 1.0 : -1.0);
  return std::abs(crossing) > kLeastCrossing && behind > kBehindPlane * voxel_m_;
}

Eigen::Vector3d VoxelSpace::MeanOf(const Surface& surface) const {
  return surface.voxel.cast<double>() * voxel_m_ +
         (surface.offset_sum / surface.points).cast<double>();
}

Surface* VoxelSpace::Find(const VoxelIndex& voxel) {
  const auto found = surface_of_voxel_.find(KeyOf(voxel));
  return found == surface_of_voxel_.end() ? nullptr : &surfaces_[found->second];
}

Block& VoxelSpace::BlockOf(const VoxelIndex& voxel) {
  const VoxelIndex index(voxel.x() >> Block::kBits, voxel.y() >> Block::kBits,
                         voxel.z() >> Block::kBits);
  if (last_block_ != nullptr && last_block_->index == index) return *last_block_;
  const auto [entry, is_new] =
      block_of_index_.emplace(KeyOf(index), static_cast<std::uint32_t>(blocks_.size()));
  if (is_new) {
    blocks_.push_back(std::make_unique<Block>());
    blocks_.back()->index = index;
  }
  last_block_ = blocks_[entry->second].get();
  return *last_block_;
}

}  // namespace hv::loop
