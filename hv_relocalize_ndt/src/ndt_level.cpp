#include "hv_relocalize_ndt/ndt_level.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>

namespace hv::relocalize {
namespace {

/// Fewest points of a voxel (paper 3.4).
constexpr std::size_t kFewestPoints = 5;
/// Smaller eigenvalues are raised to this share of the largest (methods section 3).
constexpr double kLeastEigenvalueShare = 0.01;
/// Least standard deviation [m], for voxels of points that coincide.
constexpr double kLeastSigma_m = 0.01;
/// Cosine between the normals of two planes in one cube that are kept apart.
constexpr float kParallel = 0.9F;
/// Distance of two faces of one wall or slab [m].
constexpr float kThinnestWall_m = 0.06F;
constexpr float kThickestWall_m = 0.5F;
constexpr int kSteps[7][3] = {{0, 0, 0},  {1, 0, 0}, {-1, 0, 0}, {0, 1, 0},
                              {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

/// Points of one cube, by their numbers.
using Numbers = std::vector<std::uint32_t>;

struct Spread {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d variances = Eigen::Vector3d::Zero();  ///< ascending
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
};

Spread SpreadOf(const std::vector<Eigen::Vector3f>& points, const Numbers& numbers) {
  Spread spread;
  for (const std::uint32_t i : numbers) spread.mean += points[i].cast<double>();
  const auto n = static_cast<double>(numbers.size());
  spread.mean /= n;
  Eigen::Matrix3d outer = Eigen::Matrix3d::Zero();
  for (const std::uint32_t i : numbers) {
    const Eigen::Vector3d offset = points[i].cast<double>() - spread.mean;
    outer.noalias() += offset * offset.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(outer / (n - 1.0));
  spread.variances = solver.eigenvalues().cwiseMax(kLeastSigma_m * kLeastSigma_m);
  spread.axes = solver.eigenvectors();
  return spread;
}

/// NdtVoxel::held along the axes. `inverse`: of the raised variances [1/m^2].
Eigen::Vector3d HeldAlongAxes(const Spread& spread, const Eigen::Vector3d& inverse, bool planar,
                              std::size_t points, double resolution_m) {
  if (planar) {
    // What the error of the normal seems to hold along the plane.
    const double error = spread.variances[0] / static_cast<double>(points);
    return inverse[0] *
           Eigen::Vector3d(1.0, -error / spread.variances[1], -error / spread.variances[2]);
  }
  const double spread_out = 48.0 / (resolution_m * resolution_m);
  return (inverse.array() - spread_out).cwiseMax(0.0);
}

NdtVoxel VoxelFrom(const Spread& spread, std::size_t points, double resolution_m) {
  const Eigen::Vector3d variances =
      spread.variances.cwiseMax(kLeastEigenvalueShare * spread.variances[2]);
  NdtVoxel voxel;
  voxel.mean = spread.mean.cast<float>();
  const Eigen::Vector3d inverse = variances.cwiseInverse();
  voxel.information = (spread.axes * inverse.asDiagonal() * spread.axes.transpose()).cast<float>();
  voxel.normal = spread.axes.col(0).cast<float>();
  voxel.thickness_m = static_cast<float>(std::sqrt(spread.variances[0]));
  voxel.flatness = static_cast<float>(spread.variances[0] / spread.variances[1]);
  voxel.points = static_cast<std::uint32_t>(points);
  const Eigen::Vector3d held = HeldAlongAxes(spread, inverse, voxel.planar(), points, resolution_m);
  voxel.held = (spread.axes * held.asDiagonal() * spread.axes.transpose()).cast<float>();
  return voxel;
}

/// Parts the points at the widest gap across the thinnest direction.
std::pair<Numbers, Numbers> PartAtGap(const std::vector<Eigen::Vector3f>& points, Numbers numbers,
                                      const Spread& spread) {
  const Eigen::Vector3f normal = spread.axes.col(0).cast<float>();
  const auto height = [&](std::uint32_t i) { return normal.dot(points[i]); };
  std::sort(numbers.begin(), numbers.end(),
            [&](std::uint32_t a, std::uint32_t b) { return height(a) < height(b); });
  std::size_t part = 0;
  float widest = 0.0F;
  for (std::size_t k = kFewestPoints; k + kFewestPoints <= numbers.size(); ++k) {
    const float gap = height(numbers[k]) - height(numbers[k - 1]);
    if (gap <= widest) continue;
    widest = gap;
    part = k;
  }
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(part);
  return {Numbers(numbers.begin(), middle), Numbers(middle, numbers.end())};
}

/// The voxel of a cube, or two when it holds two planes that lie apart.
void Fit(const std::vector<Eigen::Vector3f>& points, const Numbers& numbers, double resolution_m,
         std::vector<NdtVoxel>& voxels) {
  const Spread all = SpreadOf(points, numbers);
  const NdtVoxel one = VoxelFrom(all, numbers.size(), resolution_m);
  if (one.thickness_m > kThinnestWall_m && numbers.size() >= 2 * kFewestPoints) {
    const auto [low, high] = PartAtGap(points, numbers, all);
    if (!low.empty()) {
      const NdtVoxel below = VoxelFrom(SpreadOf(points, low), low.size(), resolution_m);
      const NdtVoxel above = VoxelFrom(SpreadOf(points, high), high.size(), resolution_m);
      const bool parallel = std::abs(below.normal.dot(above.normal)) > kParallel;
      const bool thin = std::max(below.thickness_m, above.thickness_m) < 0.5F * one.thickness_m;
      if (below.planar() && above.planar() && parallel && thin) {
        voxels.push_back(below);
        voxels.push_back(above);
        return;
      }
    }
  }
  voxels.push_back(one);
}

}  // namespace

NdtLevel::NdtLevel(double resolution_m, const std::vector<Eigen::Vector3f>& points)
    : resolution_m_(resolution_m), inverse_size_(static_cast<float>(1.0 / resolution_m)) {
  tsl::robin_map<std::uint64_t, std::uint32_t, CubeHash> index;
  std::vector<Numbers> cubes;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const auto [place, added] = index.try_emplace(CubeKey(points[i], inverse_size_),
                                                  static_cast<std::uint32_t>(cubes.size()));
    if (added) cubes.emplace_back();
    cubes[place->second].push_back(i);
  }
  for (const Numbers& cube : cubes) {
    if (cube.size() >= kFewestPoints) Fit(points, cube, resolution_m, voxels_);
  }
  Index();
  FindFaces();
  FindSlivers();
}

NdtLevel::NdtLevel(double resolution_m, std::vector<NdtVoxel> voxels)
    : resolution_m_(resolution_m),
      inverse_size_(static_cast<float>(1.0 / resolution_m)),
      voxels_(std::move(voxels)) {
  Index();
}

void NdtLevel::Index() {
  cubes_.reserve(4 * voxels_.size());
  for (std::uint32_t i = 0; i < voxels_.size(); ++i) {
    const Cube cube = CubeOf(voxels_[i].mean, inverse_size_);
    for (const auto& step : kSteps) {
      const std::uint64_t key = CubeKey({cube.x + step[0], cube.y + step[1], cube.z + step[2]});
      const auto [place, added] =
          cubes_.try_emplace(key, static_cast<std::uint32_t>(neighbors_.size()));
      if (added) neighbors_.emplace_back();
      Neighbors& around = neighbors_[place->second];
      if (around.count < around.voxels.size()) around.voxels[around.count++] = i;
    }
  }
}

void NdtLevel::FindFaces() {
  for (NdtVoxel& voxel : voxels_) {
    if (!voxel.planar()) continue;
    bool above = false;
    bool below = false;
    const Neighbors* around = Around(voxel.mean);
    for (std::uint32_t k = 0; k < around->count; ++k) {
      const NdtVoxel& other = voxels_[around->voxels[k]];
      if (!other.planar() || std::abs(other.normal.dot(voxel.normal)) < kParallel) continue;
      const Eigen::Vector3f offset = other.mean - voxel.mean;
      const float across = voxel.normal.dot(offset);
      const float beside = (offset - across * voxel.normal).norm();
      const bool face = std::abs(across) > kThinnestWall_m && std::abs(across) < kThickestWall_m &&
                        beside < 0.75F * static_cast<float>(resolution_m_);
      above = above || (face && across > 0.0F);
      below = below || (face && across < 0.0F);
    }
    if (above != below) voxel.facing = above ? Eigen::Vector3f(-voxel.normal) : voxel.normal;
  }
}

/// Corners of planes that a cube cuts off look like posts.
void NdtLevel::FindSlivers() {
  for (NdtVoxel& voxel : voxels_) {
    if (voxel.planar()) continue;
    const Neighbors* around = Around(voxel.mean);
    for (std::uint32_t k = 0; k < around->count; ++k) {
      const NdtVoxel& plane = voxels_[around->voxels[k]];
      const float across = plane.normal.dot(plane.mean - voxel.mean);
      if (!plane.planar() || std::abs(across) > 0.5F * kThinnestWall_m) continue;
      voxel.held = plane.normal.dot(voxel.information * plane.normal) * plane.normal *
                   plane.normal.transpose();
      break;
    }
  }
}

const NdtLevel::Neighbors* NdtLevel::Around(const Eigen::Vector3f& point) const {
  const auto found = cubes_.find(CubeKey(point, inverse_size_));
  return found == cubes_.end() ? nullptr : &neighbors_[found->second];
}

}  // namespace hv::relocalize
