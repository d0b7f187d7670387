#include "hv_relocalize_ndt/ndt_level.h"

#include <utility>

#include <Eigen/Eigenvalues>

#include "hv_core/cube_key.h"

namespace hv::relocalize {
namespace {

/// Fewest points of a voxel (paper 3.4).
constexpr std::uint32_t kFewestPoints = 5;
/// Smaller eigenvalues are raised to this share of the largest (methods section 3).
constexpr double kLeastEigenvalueShare = 0.01;
/// Least standard deviation [m], for voxels of points that coincide.
constexpr double kLeastSigma_m = 0.01;
constexpr int kSteps[7][3] = {{0, 0, 0},  {1, 0, 0}, {-1, 0, 0}, {0, 1, 0},
                              {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

/// Sums about the first point: squares of coordinates far from the origin would lose digits.
struct Moments {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d outer = Eigen::Matrix3d::Zero();
  std::uint32_t count = 0;

  void Add(const Eigen::Vector3d& point) {
    if (count == 0) origin = point;
    const Eigen::Vector3d offset = point - origin;
    sum += offset;
    outer.noalias() += offset * offset.transpose();
    ++count;
  }
};

NdtVoxel Fit(const Moments& moments) {
  const double n = static_cast<double>(moments.count);
  const Eigen::Vector3d offset = moments.sum / n;
  const Eigen::Matrix3d covariance = (moments.outer - n * offset * offset.transpose()) / (n - 1.0);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  const Eigen::Vector3d raw = solver.eigenvalues().cwiseMax(kLeastSigma_m * kLeastSigma_m);
  const Eigen::Vector3d variance = raw.cwiseMax(kLeastEigenvalueShare * raw[2]);
  NdtVoxel voxel;
  voxel.mean = (moments.origin + offset).cast<float>();
  voxel.information = (solver.eigenvectors() * variance.cwiseInverse().asDiagonal() *
                       solver.eigenvectors().transpose())
                          .cast<float>();
  voxel.normal = solver.eigenvectors().col(0).cast<float>();
  voxel.thickness_m = static_cast<float>(std::sqrt(raw[0]));
  voxel.flatness = static_cast<float>(raw[0] / raw[1]);
  voxel.points = moments.count;
  return voxel;
}

}  // namespace

NdtLevel::NdtLevel(double resolution_m, const std::vector<Eigen::Vector3f>& points)
    : resolution_m_(resolution_m), inverse_size_(static_cast<float>(1.0 / resolution_m)) {
  tsl::robin_map<std::uint64_t, std::uint32_t> index;
  std::vector<Moments> cubes;
  for (const Eigen::Vector3f& point : points) {
    const auto [place, added] =
        index.try_emplace(CubeKey(point, inverse_size_), static_cast<std::uint32_t>(cubes.size()));
    if (added) cubes.emplace_back();
    cubes[place->second].Add(point.cast<double>());
  }
  for (const Moments& cube : cubes) {
    if (cube.count >= kFewestPoints) voxels_.push_back(Fit(cube));
  }
  Index();
}

NdtLevel::NdtLevel(double resolution_m, std::vector<NdtVoxel> voxels)
    : resolution_m_(resolution_m),
      inverse_size_(static_cast<float>(1.0 / resolution_m)),
      voxels_(std::move(voxels)) {
  Index();
}

void NdtLevel::Index() {
  cubes_.reserve(4 * voxels_.size());
  own_.reserve(voxels_.size());
  for (std::uint32_t i = 0; i < voxels_.size(); ++i) {
    const Cube cube = CubeOf(voxels_[i].mean, inverse_size_);
    own_[CubeKey(cube)] = i;
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

const NdtLevel::Neighbors* NdtLevel::Around(const Eigen::Vector3f& point) const {
  const auto found = cubes_.find(CubeKey(point, inverse_size_));
  return found == cubes_.end() ? nullptr : &neighbors_[found->second];
}

const NdtVoxel* NdtLevel::At(const Eigen::Vector3f& point) const {
  const auto found = own_.find(CubeKey(point, inverse_size_));
  return found == own_.end() ? nullptr : &voxels_[found->second];
}

}  // namespace hv::relocalize
