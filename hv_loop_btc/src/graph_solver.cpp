#include "graph_solver.h"

#include <cmath>
#include <memory>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "hv_loop_btc/pose_graph_residuals.h"

namespace hv::loop {
namespace {

using RowMajor67 = Eigen::Matrix<double, 6, 7, Eigen::RowMajor>;
using RowMajor76 = Eigen::Matrix<double, 7, 6, Eigen::RowMajor>;
using RowMajor27 = Eigen::Matrix<double, 2, 7, Eigen::RowMajor>;

ceres::Problem::Options BorrowingOptions() {
  ceres::Problem::Options options;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.disable_all_safety_checks = true;
  return options;
}

void Store(const Matrix6d& jacobian, double* out) {
  if (out == nullptr) return;
  Eigen::Map<RowMajor67> map(out);
  map.leftCols<6>() = jacobian;
  map.col(6).setZero();
}

}  // namespace

PoseBlock ToBlock(const Pose& pose) {
  PoseBlock block;
  Eigen::Map<Eigen::Vector3d>(block.data()) = pose.translation();
  Eigen::Map<Eigen::Quaterniond>(block.data() + 3) = Eigen::Quaterniond(pose.linear()).normalized();
  return block;
}

Pose FromBlock(const double* block) {
  return MakePose(Eigen::Map<const Eigen::Quaterniond>(block + 3).toRotationMatrix(),
                  Eigen::Map<const Eigen::Vector3d>(block));
}

bool PoseManifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  const Pose step = se3::Exp(Eigen::Map<const Vector6d>(delta));
  const Eigen::Map<const Eigen::Quaterniond> rotation(x + 3);
  Eigen::Map<Eigen::Vector3d>(x_plus_delta).noalias() =
      Eigen::Map<const Eigen::Vector3d>(x) + rotation * step.translation();
  Eigen::Map<Eigen::Quaterniond>(x_plus_delta + 3) =
      (rotation * Eigen::Quaterniond(step.linear())).normalized();
  return true;
}

bool PoseManifold::PlusJacobian(const double* /*x*/, double* jacobian) const {
  Eigen::Map<RowMajor76>(jacobian).setIdentity();
  return true;
}

bool PoseManifold::Minus(const double* y, const double* x, double* y_minus_x) const {
  Eigen::Map<Vector6d> difference(y_minus_x);
  difference = se3::Log(FromBlock(x).inverse() * FromBlock(y));
  return true;
}

bool PoseManifold::MinusJacobian(const double* /*x*/, double* jacobian) const {
  Eigen::Map<RowMajor67>(jacobian).setIdentity();
  return true;
}

bool RelativePoseCost::Evaluate(double const* const* blocks, double* residuals,
                                double** jacobians) const {
  const Pose T_map_from = FromBlock(blocks[0]);
  const Pose T_map_to = FromBlock(blocks[1]);
  Eigen::Map<Vector6d> residual(residuals);
  if (jacobians == nullptr) {
    residual.noalias() = sqrt_information_ * RelativePoseResidual(T_from_to_, T_map_from, T_map_to);
    return true;
  }
  Matrix6d by_from;
  Matrix6d by_to;
  residual.noalias() =
      sqrt_information_ * RelativePoseResidual(T_from_to_, T_map_from, T_map_to, &by_from, &by_to);
  Store(sqrt_information_ * by_from, jacobians[0]);
  Store(sqrt_information_ * by_to, jacobians[1]);
  return true;
}

bool TiltCost::Evaluate(double const* const* blocks, double* residuals, double** jacobians) const {
  TiltJacobian by_pose;
  Eigen::Map<Eigen::Vector2d>(residuals).noalias() =
      TiltResidual(up_imu_, FromBlock(blocks[0]), &by_pose) / sigma_;
  if (jacobians == nullptr || jacobians[0] == nullptr) return true;
  Eigen::Map<RowMajor27> map(jacobians[0]);
  map.leftCols<6>() = by_pose / sigma_;
  map.col(6).setZero();
  return true;
}

Matrix6d SquareRoot(const Matrix6d& information) {
  const Eigen::LLT<Matrix6d> cholesky(information);
  if (cholesky.info() == Eigen::Success) return cholesky.matrixU();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(information);
  return solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
         solver.eigenvectors().transpose();
}

GraphSolver::GraphSolver(const std::vector<Pose>& poses)
    : parts_(poses.size()), problem_(BorrowingOptions()) {
  blocks_.reserve(poses.size());
  for (const Pose& pose : poses) {
    blocks_.push_back(ToBlock(pose));
    problem_.AddParameterBlock(blocks_.back().data(), 7, &manifold_);
  }
}

void GraphSolver::AddConstraint(const Measurement& measurement, double weight) {
  if (weight <= 0.0) return;
  auto cost = std::make_unique<RelativePoseCost>(
      measurement.T_from_to, std::sqrt(weight) * SquareRoot(measurement.information));
  problem_.AddResidualBlock(cost.release(), nullptr, blocks_[measurement.from].data(),
                            blocks_[measurement.to].data());
  parts_.Join(measurement.from, measurement.to);
}

void GraphSolver::AddTilt(const TiltMeasurement& tilt, double sigma) {
  auto cost = std::make_unique<TiltCost>(tilt.up_imu, sigma);
  problem_.AddResidualBlock(cost.release(), &tilt_loss_, blocks_[tilt.vertex].data());
}

void GraphSolver::HoldFirstOfEachPart() {
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    if (parts_.First(i) == i) problem_.SetParameterBlockConstant(blocks_[i].data());
  }
}

GraphSolver::Result GraphSolver::Solve(int max_iterations, double tolerance) {
  HoldFirstOfEachPart();
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::SUITE_SPARSE;
  // Long chains bend easily as a whole: stronger damping would keep that from being corrected.
  options.initial_trust_region_radius = 1e10;
  options.jacobi_scaling = false;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = tolerance;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem_, &summary);
  Result result;
  result.converged = summary.termination_type == ceres::CONVERGENCE;
  result.iterations = summary.num_successful_steps + summary.num_unsuccessful_steps;
  result.initial_cost = summary.initial_cost;
  result.final_cost = summary.final_cost;
  return result;
}

std::vector<Pose> GraphSolver::Poses() const {
  std::vector<Pose> poses;
  poses.reserve(blocks_.size());
  for (const PoseBlock& block : blocks_) poses.push_back(FromBlock(block.data()));
  return poses;
}

}  // namespace hv::loop
