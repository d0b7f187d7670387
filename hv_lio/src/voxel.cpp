#include "hv_lio/voxel.h"

#include <algorithm>

#include <Eigen/Eigenvalues>

namespace hv::lio {
namespace {

/// The unevenness of a surface is the same for neighbouring points: a voxel shows about this many
/// independent samples of it, however many points it holds.
constexpr double kIndependentPatches = 5.0;

}  // namespace

void VoxelFitConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("min_points", min_points, "points needed before a voxel is fitted");
  visitor.Field("plane_sigma_m", plane_sigma_m,
                "largest standard deviation across a plane [m]");
  visitor.Field("plane_flatness", plane_flatness,
                "largest ratio of the smallest to the middle standard deviation of a plane");
  visitor.Field("min_spread_m", min_spread_m,
                "smallest standard deviation along both directions of a plane [m]");
  visitor.Field("scan_sigma_m", scan_sigma_m,
                "error that all points of one scan share in a voxel [m]");
  visitor.Field("settle_scans", settle_scans,
                "scans after which a planar voxel is settled and no longer changes");
  visitor.Field("refit_percent", refit_percent, "growth after which a voxel is fitted again [%]");
  visitor.Field("gaussian_baseline_m", gaussian_baseline_m,
                "a voxel that is no plane must be seen from places this far apart, so that it "
                "shows its shape and not the pattern of the scan lines [m]");
}

void VoxelFitConfig::Validate(ConfigProblems& problems) const {
  problems.Require(min_points >= 4, "map.fit.min_points", "must be at least 4");
  problems.Require(plane_sigma_m > 0.0, "map.fit.plane_sigma_m", "must be positive");
  problems.Require(plane_flatness > 0.0 && plane_flatness < 1.0, "map.fit.plane_flatness",
                   "must lie between 0 and 1");
  problems.Require(min_spread_m >= 0.0, "map.fit.min_spread_m", "must not be negative");
  problems.Require(scan_sigma_m > 0.0, "map.fit.scan_sigma_m", "must be positive");
  problems.Require(settle_scans >= 1 && settle_scans <= 60000, "map.fit.settle_scans",
                   "must lie between 1 and 60000");
  problems.Require(gaussian_baseline_m >= 0.0, "map.fit.gaussian_baseline_m",
                   "must not be negative");
  problems.Require(refit_percent >= 0, "map.fit.refit_percent", "must not be negative");
}

void PointSums::Add(double n, const Eigen::Vector3d& mean, const Eigen::Matrix3d& scatter) {
  count += n;
  sum += n * mean;
  outer += n * (scatter + mean * mean.transpose());
}

void PointSums::Combine(const PointSums& other, const Eigen::Vector3d& offset, double sign) {
  count += sign * other.count;
  sum += sign * (other.sum + other.count * offset);
  const Eigen::Matrix3d cross = other.sum * offset.transpose();
  outer += sign * (other.outer + cross + cross.transpose() +
                   other.count * offset * offset.transpose());
}

void PointSums::Fade(double keep) {
  count *= keep;
  sum *= keep;
  outer *= keep;
}

Eigen::Matrix3d PointSums::Covariance() const {
  const Eigen::Vector3d mean = Mean();
  return outer / count - mean * mean.transpose();
}

double SurfaceFeature::PlaneVarianceAt(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d offset = point - center;
  const double first = axes.col(0).dot(offset);
  const double second = axes.col(1).dot(offset);
  const double tilt = offset_variance + variance[2] / kIndependentPatches;
  return offset_variance +
         tilt * (first * first / variance[0] + second * second / variance[1]);
}

Eigen::Matrix3d SurfaceFeature::NormalCovariance() const {
  const double offset = offset_variance + variance[2] / kIndependentPatches;
  return offset * (axes.col(0) * axes.col(0).transpose() / variance[0] +
                   axes.col(1) * axes.col(1).transpose() / variance[1]);
}

void FitFeature(const PointSums& sums, const Eigen::Vector3d& origin, double information,
                const VoxelFitConfig& config, SurfaceFeature& feature) {
  feature.kind = SurfaceFeature::Kind::kNone;
  if (sums.count < config.min_points) return;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(sums.Covariance());
  const Eigen::Vector3d& ascending = solver.eigenvalues();
  if (!ascending.allFinite()) return;
  feature.center = origin + sums.Mean();
  feature.axes = solver.eigenvectors().rowwise().reverse();
  feature.variance = ascending.reverse().cwiseMax(1e-10);
  feature.offset_variance = 1.0 / std::max(information, 1.0);
  const double thickness = feature.variance[2];
  const double width = feature.variance[1];
  const bool planar = thickness < config.plane_sigma_m * config.plane_sigma_m &&
                      thickness < config.plane_flatness * config.plane_flatness * width &&
                      width > config.min_spread_m * config.min_spread_m;
  feature.kind = planar ? SurfaceFeature::Kind::kPlane : SurfaceFeature::Kind::kGaussian;
}

}  // namespace hv::lio
