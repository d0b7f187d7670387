#include "hv_loop_btc/submap_registration.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "hv_core/cube_key.h"
#include "hv_core/so3.h"
#include "hv_loop_btc/submap.h"
#include "hv_loop_btc/view_image.h"

namespace hv::loop {
namespace {

constexpr float kFewestPoints = 6.0F;
/// Least standard deviation of a Gaussian: what scans of the same wall differ by.
constexpr double kLeastSigma_m = 0.03;
constexpr double kConverged = 1e-4;
constexpr double kConvergedCoarse = 1e-3;
/// Cosine to the vertical beyond which a plane is floor or ceiling.
constexpr double kLevel = 0.8;

struct Gaussian {
  Eigen::Vector3d mean;
  Eigen::Matrix3d information;  ///< inverse covariance
  Eigen::Matrix3d pull;         ///< weight of a residual: of a plane, across it alone
  Eigen::Vector3d normal;       ///< of the thinnest direction, towards the sensor
  bool planar = false;
};

struct SourcePoint {
  Eigen::Vector3d position;
  /// Of the surface the point lies on, towards the sensor; zero where there is no plane.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
};

/// A submap as Gaussians, one a voxel.
class GaussianGrid {
 public:
  GaussianGrid(const std::vector<Eigen::Vector3f>& points, double voxel_m)
      : inverse_size_(static_cast<float>(1.0 / voxel_m)) {
    struct Sums {
      float count = 0.0F;
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      Eigen::Matrix3d outer = Eigen::Matrix3d::Zero();
    };
    std::unordered_map<std::uint64_t, Sums> sums;
    for (const Eigen::Vector3f& point : points) {
      Sums& voxel = sums[CubeKey(point, inverse_size_)];
      const Eigen::Vector3d p = point.cast<double>();
      voxel.count += 1.0F;
      voxel.sum += p;
      voxel.outer.noalias() += p * p.transpose();
    }
    for (const auto& [key, voxel] : sums) {
      if (voxel.count < kFewestPoints) continue;
      const double n = static_cast<double>(voxel.count);
      const Eigen::Vector3d mean = voxel.sum / n;
      voxels_.emplace(key, Fit(mean, voxel.outer / n - mean * mean.transpose()));
    }
  }

  /// The Gaussian of the voxel of `point`; nullptr when it is unknown.
  const Gaussian* At(const Eigen::Vector3f& point) const {
    const auto found = voxels_.find(CubeKey(point, inverse_size_));
    return found == voxels_.end() ? nullptr : &found->second;
  }

  /// The Gaussian of the seven voxels at and around `point` that fits it best; nullptr when all are
  /// unknown. The far side of a wall is not the wall: a plane that faces away from `normal` is
  /// passed over.
  const Gaussian* Nearest(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const {
    const Cube cube = CubeOf(point.cast<float>(), inverse_size_);
    static constexpr int kSteps[7][3] = {{0, 0, 0},  {1, 0, 0}, {-1, 0, 0}, {0, 1, 0},
                                         {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    const Gaussian* best = nullptr;
    double least = 0.0;
    for (const auto& step : kSteps) {
      const auto found =
          voxels_.find(CubeKey(Cube{cube.x + step[0], cube.y + step[1], cube.z + step[2]}));
      if (found == voxels_.end()) continue;
      if (found->second.planar && found->second.normal.dot(normal) < 0.0) continue;
      const Eigen::Vector3d offset = point - found->second.mean;
      const double distance = offset.dot(found->second.information * offset);
      if (best != nullptr && distance >= least) continue;
      best = &found->second;
      least = distance;
    }
    return best;
  }

 private:
  static Gaussian Fit(const Eigen::Vector3d& mean, const Eigen::Matrix3d& covariance) {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(covariance);
    const Eigen::Vector3d variance = solver.eigenvalues().cwiseMax(kLeastSigma_m * kLeastSigma_m);
    Gaussian gaussian;
    gaussian.mean = mean;
    gaussian.normal = solver.eigenvectors().col(0);
    if (gaussian.normal.dot(mean) > 0.0) gaussian.normal = -gaussian.normal;
    gaussian.planar = variance[0] < 0.1 * variance[1];
    gaussian.information = solver.eigenvectors() * variance.cwiseInverse().asDiagonal() *
                           solver.eigenvectors().transpose();
    gaussian.pull = gaussian.information;
    if (gaussian.planar) {
      gaussian.pull = gaussian.normal * gaussian.normal.transpose() / variance[0];
    }
    return gaussian;
  }

  float inverse_size_;
  std::unordered_map<std::uint64_t, Gaussian> voxels_;
};

struct NormalEquations {
  Matrix6d information = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
};

/// Sum over the source points; Geman-McClure weights of scale `robust` sigmas.
NormalEquations Linearize(const GaussianGrid& target, const std::vector<SourcePoint>& source,
                          const Pose& pose, double robust) {
  NormalEquations equations;
  for (const SourcePoint& point : source) {
    const Eigen::Vector3d moved = pose * point.position;
    const Gaussian* gaussian = target.Nearest(moved, pose.linear() * point.normal);
    if (gaussian == nullptr) continue;
    const Eigen::Vector3d residual = moved - gaussian->mean;
    const double squared = residual.dot(gaussian->information * residual);
    const double ratio = robust * robust / (robust * robust + squared);
    Eigen::Matrix<double, 3, 6> jacobian;
    jacobian.leftCols<3>() = pose.linear();
    jacobian.rightCols<3>() = -pose.linear() * so3::Hat(point.position);
    const Eigen::Matrix<double, 6, 3> weighted =
        ratio * ratio * jacobian.transpose() * gaussian->pull;
    equations.information.noalias() += weighted * jacobian;
    equations.gradient.noalias() += weighted * residual;
  }
  return equations;
}

void JudgeFit(const GaussianGrid& target, const std::vector<SourcePoint>& source,
              const Eigen::Vector3d& source_up, double inlier_m, RegistrationResult& result) {
  const Eigen::Vector3d up = result.T_target_source.linear() * source_up;
  std::size_t known = 0;
  std::size_t upright = 0;
  std::size_t inliers = 0;
  double squares = 0.0;
  for (const SourcePoint& point : source) {
    const Eigen::Vector3d moved = result.T_target_source * point.position;
    const Gaussian* gaussian =
        target.Nearest(moved, result.T_target_source.linear() * point.normal);
    if (gaussian == nullptr) continue;
    ++known;
    if (gaussian->planar && std::abs(gaussian->normal.dot(up)) > kLevel) continue;
    ++upright;
    const Eigen::Vector3d offset = moved - gaussian->mean;
    const double across = std::abs(offset.dot(gaussian->normal));
    const bool on_plane = gaussian->planar && across < inlier_m;
    const bool in_blob = !gaussian->planar && offset.dot(gaussian->information * offset) < 9.0;
    if (!on_plane && !in_blob) continue;
    ++inliers;
    squares += across * across;
  }
  if (known == 0 || inliers == 0) return;
  result.overlap = static_cast<double>(known) / static_cast<double>(source.size());
  result.fitness = static_cast<double>(inliers) / static_cast<double>(upright);
  result.rmse_m = std::sqrt(squares / static_cast<double>(inliers));
}

/// Share of the points of either cloud that the other sees through.
double SeenThrough(const std::vector<Eigen::Vector3f>& target,
                   const std::vector<Eigen::Vector3f>& source, const Pose& T_target_source) {
  const ViewImage::Comparison a = ViewImage(target).Compare(source, T_target_source);
  const ViewImage::Comparison b = ViewImage(source).Compare(target, T_target_source.inverse());
  const std::size_t compared = a.compared + b.compared;
  if (compared == 0) return 0.0;
  return static_cast<double>(a.seen_through + b.seen_through) / static_cast<double>(compared);
}

/// The source thinned to cubes of `leaf_m`, with normals of its own voxels.
std::vector<SourcePoint> SourcePoints(const std::vector<Eigen::Vector3f>& source, double leaf_m,
                                      double voxel_m) {
  const GaussianGrid surfaces(source, voxel_m);
  std::vector<SourcePoint> points;
  for (const Eigen::Vector3f& thinned : Thinned(source, leaf_m)) {
    SourcePoint& point = points.emplace_back();
    point.position = thinned.cast<double>();
    const Gaussian* surface = surfaces.At(thinned);
    if (surface != nullptr && surface->planar) point.normal = surface->normal;
  }
  return points;
}

}  // namespace

void RegistrationConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("coarse_voxel_m", coarse_voxel_m, "voxels of the first alignment [m]");
  visitor.Field("fine_voxel_m", fine_voxel_m, "voxels of the last alignment [m]");
  visitor.Field("source_leaf_m", source_leaf_m, "edge of the cubes the source is thinned with [m]");
  visitor.Field("max_iterations", max_iterations, "most iterations of one alignment");
  visitor.Field("inlier_m", inlier_m, "distance from a surface at which a point lies on it [m]");
  visitor.Field("min_fitness", min_fitness,
                "share of the points that must lie on known surfaces, 0 to 1");
  visitor.Field("max_seen_through", max_seen_through,
                "share of points that the other submap sees through beyond which an alignment is "
                "given up, 0 to 1");
}

void RegistrationConfig::Validate(ConfigProblems& problems) const {
  problems.Require(fine_voxel_m > 0.0, "registration.fine_voxel_m", "must be positive");
  problems.Require(coarse_voxel_m >= fine_voxel_m, "registration.coarse_voxel_m",
                   "must be at least fine_voxel_m");
  problems.Require(source_leaf_m > 0.0, "registration.source_leaf_m", "must be positive");
  problems.Require(max_iterations >= 1, "registration.max_iterations", "must be at least 1");
  problems.Require(inlier_m > 0.0, "registration.inlier_m", "must be positive");
  problems.Require(min_fitness >= 0.0 && min_fitness <= 1.0, "registration.min_fitness",
                   "must lie between 0 and 1");
  problems.Require(max_seen_through > 0.0 && max_seen_through <= 1.0,
                   "registration.max_seen_through", "must lie between 0 and 1");
}

RegistrationResult SubmapRegistration::Align(const std::vector<Eigen::Vector3f>& target,
                                             const std::vector<Eigen::Vector3f>& source,
                                             const Eigen::Vector3d& source_up,
                                             const Pose& T_target_source_guess) const {
  RegistrationResult result;
  result.T_target_source = T_target_source_guess;
  const std::vector<SourcePoint> points =
      SourcePoints(source, config_.source_leaf_m, config_.fine_voxel_m);
  if (points.empty()) return result;
  struct Stage {
    double voxel_m;
    double robust_sigmas;
    double converged;
  };
  const Stage stages[] = {{2.0 * config_.coarse_voxel_m, 6.0, kConvergedCoarse},
                          {config_.coarse_voxel_m, 4.0, kConvergedCoarse},
                          {config_.fine_voxel_m, 3.0, kConverged}};
  for (const Stage& stage : stages) {
    const GaussianGrid grid(target, stage.voxel_m);
    result.converged = false;
    for (int i = 0; i < config_.max_iterations && !result.converged; ++i) {
      const NormalEquations equations =
          Linearize(grid, points, result.T_target_source, stage.robust_sigmas);
      const Matrix6d damped = equations.information + 1e-6 * Matrix6d::Identity();
      const Vector6d step = -damped.ldlt().solve(equations.gradient);
      result.T_target_source = result.T_target_source * se3::Exp(step);
      result.information = equations.information;
      result.converged = step.norm() < stage.converged;
      ++result.iterations;
    }
    result.seen_through = SeenThrough(target, source, result.T_target_source);
    if (result.seen_through > config_.max_seen_through) return result;
    if (&stage == &stages[2]) JudgeFit(grid, points, source_up, config_.inlier_m, result);
  }
  return result;
}

}  // namespace hv::loop
