#include "hv_loop_btc/plane_voxels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <unordered_map>

#include <Eigen/Eigenvalues>

#include "hv_core/cube_key.h"

namespace hv::loop {
namespace {

/// Two normals within about 6 deg.
constexpr float kSameNormal = 0.995F;
constexpr float kNearlyHorizontal = 0.97F;
constexpr float kSamePlane_m = 0.3F;
/// Share of the points that may lie under a floor that no plane shows.
constexpr double kUnderFloor = 0.02;

/// Sums of one voxel's points, relative to its first point.
struct Sums {
  Eigen::Vector3f origin;
  float count = 0.0F;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Matrix3f outer = Eigen::Matrix3f::Zero();

  void Add(const Eigen::Vector3f& point) {
    const Eigen::Vector3f offset = point - origin;
    count += 1.0F;
    sum += offset;
    outer.noalias() += offset * offset.transpose();
  }
};

std::optional<PlaneVoxel> FitPlane(const Sums& sums, const PlaneVoxelLimits& limits) {
  if (sums.count < static_cast<float>(limits.min_points)) return std::nullopt;
  const Eigen::Vector3f mean = sums.sum / sums.count;
  const Eigen::Matrix3f covariance = sums.outer / sums.count - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(covariance);
  const Eigen::Vector3f& ascending = solver.eigenvalues();
  const float limit = static_cast<float>(limits.max_thickness_m * limits.max_thickness_m);
  const bool thin = ascending[0] < limit && ascending[0] < 0.1F * ascending[1];
  if (!ascending.allFinite() || !thin) return std::nullopt;
  return PlaneVoxel{sums.origin + mean, solver.eigenvectors().col(0), sums.count};
}

/// Plane through the voxels near `seed`'s plane; every voxel counts once.
ReferencePlane GrowPlane(const PlaneVoxel& seed, const std::vector<PlaneVoxel>& voxels) {
  const float offset = seed.normal.dot(seed.center);
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  ReferencePlane plane;
  for (const PlaneVoxel& voxel : voxels) {
    const float alike = seed.normal.dot(voxel.normal);
    if (std::abs(alike) < kSameNormal) continue;
    if (std::abs(seed.normal.dot(voxel.center) - offset) > kSamePlane_m) continue;
    normal += (alike > 0.0F ? voxel.normal : Eigen::Vector3f(-voxel.normal)).cast<double>();
    center += voxel.center.cast<double>();
    plane.support += 1.0;
  }
  plane.normal = normal.normalized();
  plane.offset = plane.normal.dot(center) / plane.support;
  return plane;
}

/// Best supported plane among those grown from every n-th of the voxels that `wanted` accepts.
template <typename Wanted>
std::optional<ReferencePlane> BestPlane(const std::vector<PlaneVoxel>& voxels,
                                        const Wanted& wanted) {
  constexpr std::size_t kSeeds = 60;
  std::vector<const PlaneVoxel*> candidates;
  for (const PlaneVoxel& voxel : voxels) {
    if (wanted(voxel)) candidates.push_back(&voxel);
  }
  std::optional<ReferencePlane> best;
  const std::size_t step = std::max<std::size_t>(1, candidates.size() / kSeeds);
  for (std::size_t i = 0; i < candidates.size(); i += step) {
    const ReferencePlane plane = GrowPlane(*candidates[i], voxels);
    if (!best || plane.support > best->support) best = plane;
  }
  return best;
}

ReferencePlane UnderNearlyAll(const std::vector<Eigen::Vector3f>& points,
                              const Eigen::Vector3d& up) {
  std::vector<float> heights;
  heights.reserve(points.size());
  for (const Eigen::Vector3f& point : points) heights.push_back(point.dot(up.cast<float>()));
  ReferencePlane plane;
  plane.normal = up;
  if (heights.empty()) return plane;
  const auto rank =
      static_cast<std::ptrdiff_t>(kUnderFloor * static_cast<double>(heights.size() - 1));
  std::nth_element(heights.begin(), heights.begin() + rank, heights.end());
  plane.offset = static_cast<double>(heights[static_cast<std::size_t>(rank)]);
  return plane;
}

}  // namespace

std::vector<PlaneVoxel> ExtractPlaneVoxels(const std::vector<Eigen::Vector3f>& points,
                                           const PlaneVoxelLimits& limits) {
  const float inverse_size = static_cast<float>(1.0 / limits.voxel_m);
  std::unordered_map<std::uint64_t, std::uint32_t> index;
  std::vector<Sums> sums;
  for (const Eigen::Vector3f& point : points) {
    const auto [place, added] =
        index.try_emplace(CubeKey(point, inverse_size), static_cast<std::uint32_t>(sums.size()));
    if (added) sums.push_back({point});
    sums[place->second].Add(point);
  }
  std::vector<PlaneVoxel> voxels;
  for (const Sums& voxel : sums) {
    if (const auto plane = FitPlane(voxel, limits)) voxels.push_back(*plane);
  }
  return voxels;
}

ReferencePlane FindFloor(const std::vector<PlaneVoxel>& voxels, const Eigen::Vector3d& up,
                         const std::vector<Eigen::Vector3f>& points) {
  const Eigen::Vector3f up_f = up.cast<float>();
  const auto below = [&](const PlaneVoxel& voxel) {
    return std::abs(voxel.normal.dot(up_f)) > kNearlyHorizontal && voxel.center.dot(up_f) < 0.0F;
  };
  std::optional<ReferencePlane> floor = BestPlane(voxels, below);
  if (!floor) return UnderNearlyAll(points, up);
  if (floor->normal.dot(up) < 0.0) {
    floor->normal = -floor->normal;
    floor->offset = -floor->offset;
  }
  return *floor;
}

}  // namespace hv::loop
