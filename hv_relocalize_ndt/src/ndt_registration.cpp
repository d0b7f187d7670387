#include "hv_relocalize_ndt/ndt_registration.h"

#include <algorithm>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "hv_core/so3.h"
#include "hv_loop_btc/submap.h"
#include "hv_relocalize_ndt/robust_mixture.h"

namespace hv::relocalize {
namespace {

constexpr std::size_t kGrain = 256;
constexpr double kFirstDamping = 1e-3;
constexpr double kMostDamping = 1e5;
/// Exponents beyond which a voxel no longer draws a point.
constexpr float kFarthest = 18.0F;

/// Derivatives for a perturbation of the pose by a translation along the axes of the target and a
/// rotation about them, centred at the source: cheaper to sum than those of a right perturbation.
struct WorldCost {
  double cost = 0.0;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  Eigen::Matrix3d tt = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d tr = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d rr = Eigen::Matrix3d::Zero();

  void Add(const WorldCost& other) {
    cost += other.cost;
    force += other.force;
    torque += other.torque;
    tt += other.tt;
    tr += other.tr;
    rr += other.rr;
  }
};

/// A part of a voxel that gives a symmetric matrix.
using VoxelMatrix = Eigen::Matrix3f NdtVoxel::*;

struct Evaluation {
  const NdtLevel& target;
  RobustMixture mixture;
  const std::vector<Eigen::Vector3f>& source;
  Eigen::Matrix3f rotation;
  Eigen::Vector3f translation;
  VoxelMatrix stiffness_of;

  /// Eq. 22-23 of the points [begin, end).
  WorldCost Sum(std::size_t begin, std::size_t end) const {
    const auto d1 = static_cast<float>(mixture.d1);
    const auto d2 = static_cast<float>(mixture.d2);
    WorldCost sum;
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3f arm = rotation * source[i];
      const Eigen::Vector3f moved = arm + translation;
      const NdtLevel::Neighbors* around = target.Around(moved);
      if (around == nullptr) continue;
      Eigen::Vector3f force = Eigen::Vector3f::Zero();
      Eigen::Matrix3f stiffness = Eigen::Matrix3f::Zero();
      float cost = 0.0F;
      for (std::uint32_t k = 0; k < around->count; ++k) {
        const NdtVoxel& voxel = target.voxels()[around->voxels[k]];
        if (voxel.facing.dot(arm) > 0.0F) continue;
        const Eigen::Vector3f residual = moved - voxel.mean;
        const Eigen::Vector3f drawn = voxel.information * residual;
        const float exponent = 0.5F * d2 * residual.dot(drawn);
        if (!(exponent < kFarthest)) continue;
        const float value = d1 * std::exp(-exponent);
        cost += value;
        force -= d2 * value * drawn;
        stiffness -= d2 * value * voxel.*stiffness_of;
      }
      const Eigen::Matrix3f cross = stiffness * so3::Hat(arm.cast<double>()).cast<float>();
      sum.cost += static_cast<double>(cost);
      sum.force += force.cast<double>();
      sum.torque += arm.cross(force).cast<double>();
      sum.tt += stiffness.cast<double>();
      sum.tr -= cross.cast<double>();
      sum.rr -= (so3::Hat(arm.cast<double>()).cast<float>() * cross).cast<double>();
    }
    return sum;
  }
};

NdtCost Evaluate(const NdtLevel& target, double outlier_share,
                 const std::vector<Eigen::Vector3f>& source, const Pose& T_target_source,
                 VoxelMatrix stiffness_of) {
  const Evaluation evaluation{target,
                              RobustMixture::For(target.resolution_m(), outlier_share),
                              source,
                              T_target_source.linear().cast<float>(),
                              T_target_source.translation().cast<float>(),
                              stiffness_of};
  const WorldCost sum = tbb::parallel_deterministic_reduce(
      tbb::blocked_range<std::size_t>(0, source.size(), kGrain), WorldCost(),
      [&](const tbb::blocked_range<std::size_t>& range, WorldCost partial) {
        partial.Add(evaluation.Sum(range.begin(), range.end()));
        return partial;
      },
      [](WorldCost a, const WorldCost& b) {
        a.Add(b);
        return a;
      });
  const Eigen::Matrix3d& R = T_target_source.linear();
  NdtCost result;
  result.cost = sum.cost;
  result.gradient << R.transpose() * sum.force, R.transpose() * sum.torque;
  result.hessian.topLeftCorner<3, 3>() = R.transpose() * sum.tt * R;
  result.hessian.topRightCorner<3, 3>() = R.transpose() * sum.tr * R;
  result.hessian.bottomLeftCorner<3, 3>() = result.hessian.topRightCorner<3, 3>().transpose();
  result.hessian.bottomRightCorner<3, 3>() = R.transpose() * sum.rr * R;
  return result;
}

}  // namespace

void NdtConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("resolutions_m", resolutions_m, "edges of the voxels, coarse to fine [m]");
  visitor.Field("outlier_share", outlier_share, "share of points that fit nothing, 0 to 1");
  visitor.Field("leaf_share", leaf_share,
                "edge of the cubes the scan is thinned with, share of the voxels' edge");
  visitor.Field("min_leaf_m", min_leaf_m, "least edge of these cubes [m]");
  visitor.Field("max_iterations", max_iterations, "most iterations at one level");
  visitor.Field("converged_share", converged_share,
                "step that ends a level, share of the voxels' edge");
}

void NdtConfig::Validate(ConfigProblems& problems) const {
  problems.Require(!resolutions_m.empty(), "ndt.resolutions_m", "must name a level at least");
  for (std::size_t i = 0; i < resolutions_m.size(); ++i) {
    problems.Require(resolutions_m[i] > 0.0, "ndt.resolutions_m", "must be positive");
    problems.Require(i == 0 || resolutions_m[i] < resolutions_m[i - 1], "ndt.resolutions_m",
                     "must fall from level to level");
  }
  problems.Require(outlier_share > 0.0 && outlier_share < 1.0, "ndt.outlier_share",
                   "must lie between 0 and 1");
  problems.Require(leaf_share > 0.0, "ndt.leaf_share", "must be positive");
  problems.Require(min_leaf_m > 0.0, "ndt.min_leaf_m", "must be positive");
  problems.Require(max_iterations >= 1, "ndt.max_iterations", "must be at least 1");
  problems.Require(converged_share > 0.0, "ndt.converged_share", "must be positive");
}

NdtCost EvaluateNdt(const NdtLevel& target, double outlier_share,
                    const std::vector<Eigen::Vector3f>& source, const Pose& T_target_source) {
  return Evaluate(target, outlier_share, source, T_target_source, &NdtVoxel::information);
}

Matrix6d InformationOf(const NdtLevel& target, double outlier_share,
                       const std::vector<Eigen::Vector3f>& source, const Pose& T_target_source) {
  return Evaluate(target, outlier_share, source, T_target_source, &NdtVoxel::held).hessian;
}

NdtSource::NdtSource(const NdtConfig& config, const std::vector<Eigen::Vector3f>& points)
    : config_(config), points_(loop::Thinned(points, config.min_leaf_m)) {}

std::vector<Eigen::Vector3f> NdtSource::For(double resolution_m) const {
  const double leaf = config_.leaf_share * resolution_m;
  return leaf > config_.min_leaf_m ? loop::Thinned(points_, leaf) : points_;
}

Matrix6d CovarianceOf(const NdtResult& result, double scale) {
  constexpr double kLeastInformation = 1e-3;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(result.information);
  const Vector6d variances =
      scale * solver.eigenvalues().cwiseMax(kLeastInformation).cwiseInverse();
  return solver.eigenvectors() * variances.asDiagonal() * solver.eigenvectors().transpose();
}

NdtResult NdtRegistration::Align(const std::vector<const NdtLevel*>& levels,
                                 const NdtSource& source, const Pose& T_target_source_guess) const {
  NdtResult result;
  result.T_target_source = T_target_source_guess;
  for (const NdtLevel* level : levels) {
    const std::vector<Eigen::Vector3f> points = source.For(level->resolution_m());
    AlignLevel(*level, points, result);
    if (level != levels.back()) continue;
    result.information =
        InformationOf(*level, config_.outlier_share, points, result.T_target_source);
  }
  return result;
}

void NdtRegistration::AlignLevel(const NdtLevel& level, const std::vector<Eigen::Vector3f>& source,
                                 NdtResult& result) const {
  double damping = kFirstDamping;
  NdtCost at = EvaluateNdt(level, config_.outlier_share, source, result.T_target_source);
  result.converged = false;
  for (int i = 0; i < config_.max_iterations && !result.converged && damping < kMostDamping; ++i) {
    ++result.iterations;
    Matrix6d damped = at.hessian;
    damped.diagonal() += damping * at.hessian.diagonal() + Vector6d::Constant(1e-9);
    const Vector6d step = -damped.ldlt().solve(at.gradient);
    const Pose moved = result.T_target_source * se3::Exp(step);
    const NdtCost there = EvaluateNdt(level, config_.outlier_share, source, moved);
    result.converged = step.norm() < config_.converged_share * level.resolution_m();
    if (!(there.cost < at.cost)) {
      damping *= 10.0;
      continue;
    }
    damping *= 0.2;
    at = there;
    result.T_target_source = moved;
  }
  if (!source.empty()) result.cost_per_point = at.cost / static_cast<double>(source.size());
}

}  // namespace hv::relocalize
