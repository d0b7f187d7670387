#include "hv_lio/scan_update.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "hv_lio/residual.h"

namespace hv::lio {
namespace {

constexpr std::size_t kCellsPerTask = 256;
/// Variance of the axes of a Gaussian, which are known to about 20 degrees [rad^2].
constexpr double kGaussianTiltVariance = 0.1;

}  // namespace

void UpdateConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("max_iterations", max_iterations, "most iterations of an update");
  visitor.Field("convergence", convergence, "step below which an update has converged [m, rad]");
  visitor.Field("gate_sigmas", gate_sigmas, "residuals beyond this many sigmas are refused");
  visitor.Field("huber_sigmas", huber_sigmas, "residuals beyond this many sigmas weigh less");
  visitor.Field("model_sigma_m", model_sigma_m,
                "what surfaces deviate from planes and Gaussians [m]");
  visitor.Field("gaussian_weight", gaussian_weight,
                "weight of residuals against Gaussians relative to planes");
  visitor.Field("gaussian_sigma_m", gaussian_sigma_m,
                "directions in which a Gaussian is wider than this constrain nothing [m]");
  visitor.Field("information_scale", information_scale,
                "share of the residuals that count as independent");
  visitor.Field("map_sigma_m", map_sigma_m,
                "error of the map that all residuals of a scan share, translation [m]");
  visitor.Field("map_sigma_rad", map_sigma_rad,
                "the same for rotation; larger values let gravity level the map [rad]");
  visitor.Field("settling_sigma_m", settling_sigma_m,
                "map_sigma_m after a start in motion, while scans are skewed by unknown motion [m]");
  visitor.Field("settling_sigma_rad", settling_sigma_rad, "the same for rotation [rad]");
  visitor.Field("min_residuals", min_residuals, "fewest residuals for an update");
  visitor.Field("degenerate_sigma_m", degenerate_sigma_m,
                "a direction that the scan alone leaves less certain than this is degenerate [m]");
  visitor.Field("degenerate_sigma_rad", degenerate_sigma_rad, "the same for rotation [rad]");
  visitor.Field("degenerate_noise_ratio", degenerate_noise_ratio,
                "a direction is degenerate when its constraint is less than this many times what "
                "uncertain normals alone would feign");
  visitor.Field("degenerate_map_sigma_m", degenerate_map_sigma_m,
                "map_sigma_m while a direction is degenerate: keeps the well-known directions from "
                "leaking into it through the error of its axis [m]");
  visitor.Field("degenerate_accel_noise", degenerate_accel_noise,
                "velocity random walk along directions that the IMU alone observes, for the error "
                "of its bias that the filter cannot know [m/s^2/sqrt(Hz)]");
}

void UpdateConfig::Validate(ConfigProblems& problems) const {
  problems.Require(max_iterations >= 1, "update.max_iterations", "must be at least 1");
  problems.Require(convergence > 0.0, "update.convergence", "must be positive");
  problems.Require(gate_sigmas > 0.0, "update.gate_sigmas", "must be positive");
  problems.Require(huber_sigmas > 0.0, "update.huber_sigmas", "must be positive");
  problems.Require(model_sigma_m >= 0.0, "update.model_sigma_m", "must not be negative");
  problems.Require(gaussian_weight >= 0.0 && gaussian_weight <= 1.0, "update.gaussian_weight",
                   "must lie between 0 and 1");
  problems.Require(gaussian_sigma_m > 0.0, "update.gaussian_sigma_m", "must be positive");
  problems.Require(information_scale > 0.0 && information_scale <= 1.0,
                   "update.information_scale", "must be positive and at most 1");
  problems.Require(map_sigma_m >= 0.0, "update.map_sigma_m", "must not be negative");
  problems.Require(map_sigma_rad >= 0.0, "update.map_sigma_rad", "must not be negative");
  problems.Require(settling_sigma_m >= 0.0, "update.settling_sigma_m", "must not be negative");
  problems.Require(settling_sigma_rad >= 0.0, "update.settling_sigma_rad",
                   "must not be negative");
  problems.Require(min_residuals >= 6, "update.min_residuals", "must be at least 6");
  problems.Require(degenerate_sigma_m > 0.0, "update.degenerate_sigma_m", "must be positive");
  problems.Require(degenerate_sigma_rad > 0.0, "update.degenerate_sigma_rad",
                   "must be positive");
  problems.Require(degenerate_noise_ratio >= 0.0, "update.degenerate_noise_ratio",
                   "must not be negative");
  problems.Require(degenerate_map_sigma_m >= 0.0, "update.degenerate_map_sigma_m",
                   "must not be negative");
  problems.Require(degenerate_accel_noise >= 0.0, "update.degenerate_accel_noise",
                   "must not be negative");
}

/// Normal equations of the pose and what goes with them.
struct ScanUpdate::Normal {
  Matrix6d information = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  std::size_t count = 0;
  std::size_t planar = 0;
  double abs_residual = 0.0;
  /// Translation information that the uncertainty of the normals feigns.
  Eigen::Matrix3d feigned = Eigen::Matrix3d::Zero();

  void Add(const Residual& residual, double weight, const Eigen::Matrix3d& normal_covariance) {
    feigned += weight * normal_covariance;
    const Vector6d scaled = weight * residual.jacobian;
    information.noalias() += scaled * residual.jacobian.transpose();
    gradient += residual.value * scaled;
    abs_residual += std::abs(residual.value);
    ++count;
  }

  void Add(const Normal& other) {
    information += other.information;
    gradient += other.gradient;
    count += other.count;
    planar += other.planar;
    abs_residual += other.abs_residual;
    feigned += other.feigned;
  }
};

void ScanUpdate::AddCell(const SurfaceCell& cell, const SurfaceFeature& feature,
                         const Pose& T_odom_imu, const Matrix6d& pose_covariance,
                         Normal& normal) const {
  const double model_variance = config_.model_sigma_m * config_.model_sigma_m;
  const auto weigh = [&](Residual& residual, double factor, const Eigen::Matrix3d& tilt) {
    residual.variance += model_variance;
    const double predicted =
        residual.variance + residual.jacobian.dot(pose_covariance * residual.jacobian);
    const double squared = residual.value * residual.value;
    if (squared > config_.gate_sigmas * config_.gate_sigmas * predicted) return false;
    const double sigmas = std::sqrt(squared / residual.variance);
    const double robust = std::min(1.0, config_.huber_sigmas / std::max(sigmas, 1e-12));
    normal.Add(residual, factor * robust / residual.variance, tilt);
    return true;
  };
  if (feature.kind == SurfaceFeature::Kind::kPlane) {
    Residual residual = PlaneResidual(cell, feature, T_odom_imu);
    const Eigen::Matrix3d tilt = feature.NormalCovariance();
    if (weigh(residual, config_.information_scale, tilt)) ++normal.planar;
    return;
  }
  if (config_.gaussian_weight == 0.0) return;
  const Eigen::Matrix3d isotropic_tilt = kGaussianTiltVariance * Eigen::Matrix3d::Identity();
  for (int axis = 0; axis < 3; ++axis) {
    if (feature.variance[axis] > config_.gaussian_sigma_m * config_.gaussian_sigma_m) continue;
    Residual residual = GaussianResidual(cell, feature, axis, T_odom_imu);
    weigh(residual, config_.information_scale * config_.gaussian_weight, isotropic_tilt);
  }
}

ScanUpdate::Normal ScanUpdate::Accumulate(const std::vector<SurfaceCell>& cells,
                                          const VoxelMap& map, const Pose& T_odom_imu,
                                          const Matrix6d& pose_covariance) const {
  const std::size_t tasks = (cells.size() + kCellsPerTask - 1) / kCellsPerTask;
  std::vector<Normal> parts(tasks);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tasks, 1),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t task = range.begin(); task != range.end(); ++task) {
                        const std::size_t end = std::min(cells.size(), (task + 1) * kCellsPerTask);
                        for (std::size_t i = task * kCellsPerTask; i < end; ++i) {
                          const SurfaceFeature* feature = map.Find(T_odom_imu * cells[i].mean);
                          if (feature == nullptr) continue;
                          AddCell(cells[i], *feature, T_odom_imu, pose_covariance, parts[task]);
                        }
                      }
                    });
  Normal total;
  for (const Normal& part : parts) total.Add(part);
  return total;
}

void ScanUpdate::FindDegenerate(const Normal& normal, UpdateSummary& summary) const {
  const auto weak = [](const Eigen::Matrix3d& information, const Eigen::Matrix3d& feigned,
                       double sigma) {
    std::vector<Eigen::Vector3d> found;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(information);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d direction = solver.eigenvectors().col(i);
      const double least =
          std::max(1.0 / (sigma * sigma), direction.dot(feigned * direction));
      if (solver.eigenvalues()[i] < least) found.push_back(direction);
    }
    return found;
  };
  summary.degenerate_translation =
      weak(normal.information.topLeftCorner<3, 3>(),
           config_.degenerate_noise_ratio * normal.feigned, config_.degenerate_sigma_m);
  summary.degenerate_rotation = weak(normal.information.bottomRightCorner<3, 3>(),
                                     Eigen::Matrix3d::Zero(), config_.degenerate_sigma_rad);
}

void ScanUpdate::RemoveDegenerate(const UpdateSummary& summary, Normal& normal) {
  Matrix6d keep = Matrix6d::Identity();
  for (const Eigen::Vector3d& direction : summary.degenerate_translation) {
    keep.topLeftCorner<3, 3>() -= direction * direction.transpose();
  }
  for (const Eigen::Vector3d& direction : summary.degenerate_rotation) {
    keep.bottomRightCorner<3, 3>() -= direction * direction.transpose();
  }
  normal.information = keep * normal.information * keep;
  normal.gradient = keep * normal.gradient;
}

void ScanUpdate::AddMapNoise(double sigma_m, double sigma_rad, Normal& normal) {
  Vector6d variance;
  variance.head<3>().setConstant(sigma_m * sigma_m);
  variance.tail<3>().setConstant(sigma_rad * sigma_rad);
  const Matrix6d widened = Matrix6d::Identity() + normal.information * variance.asDiagonal();
  const Eigen::PartialPivLU<Matrix6d> solver(widened);
  const Matrix6d information = solver.solve(normal.information);
  normal.information = 0.5 * (information + information.transpose());
  normal.gradient = solver.solve(normal.gradient).eval();
}

UpdateSummary ScanUpdate::Apply(const std::vector<SurfaceCell>& cells, const VoxelMap& map,
                                bool settling, NavState& state, ErrorMatrix& covariance) const {
  UpdateSummary summary;
  const NavState prior = state;
  const ErrorMatrix prior_information = covariance.llt().solve(ErrorMatrix::Identity());
  const Matrix6d pose_covariance = covariance.topLeftCorner<6, 6>();
  NavState current = prior;
  ErrorMatrix information;
  const int max_iterations = settling ? 3 * config_.max_iterations : config_.max_iterations;
  while (summary.iterations < max_iterations && !summary.converged) {
    Normal normal = Accumulate(cells, map, current.T_odom_imu(), pose_covariance);
    if (normal.count < static_cast<std::size_t>(config_.min_residuals)) return UpdateSummary();
    if (!settling) FindDegenerate(normal, summary);
    RemoveDegenerate(summary, normal);
    const double degenerate_sigma =
        summary.degenerate_translation.empty() ? 0.0 : config_.degenerate_map_sigma_m;
    const double settling_sigma = settling ? config_.settling_sigma_m : 0.0;
    AddMapNoise(std::max({config_.map_sigma_m, degenerate_sigma, settling_sigma}),
                settling ? config_.settling_sigma_rad : config_.map_sigma_rad, normal);
    const ErrorVector deviation = current.Minus(prior);
    const ErrorMatrix to_prior = current.MinusJacobian(prior);
    information = to_prior.transpose() * prior_information * to_prior;
    ErrorVector gradient = to_prior.transpose() * (prior_information * deviation);
    information.topLeftCorner<6, 6>() += normal.information;
    gradient.head<6>() += normal.gradient;
    const ErrorVector step = -information.ldlt().solve(gradient);
    current = current.Plus(step);
    ++summary.iterations;
    summary.converged = step.head<6>().cwiseAbs().maxCoeff() < config_.convergence;
    summary.residuals = normal.count;
    summary.planar = normal.planar;
    summary.mean_abs_residual_m = normal.abs_residual / static_cast<double>(normal.count);
  }
  state = current;
  covariance = information.llt().solve(ErrorMatrix::Identity());
  covariance = 0.5 * (covariance + covariance.transpose()).eval();
  return summary;
}

}  // namespace hv::lio
