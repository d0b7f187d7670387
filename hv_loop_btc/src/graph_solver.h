#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <ceres/ceres.h>

#include "disjoint_sets.h"
#include "hv_core/se3.h"
#include "measurement.h"

namespace hv::loop {

/// A pose as Ceres stores it: translation [m], then the quaternion x y z w.
using PoseBlock = std::array<double, 7>;

PoseBlock ToBlock(const Pose& pose);
Pose FromBlock(const double* block);

/// SE(3) with right-multiplied perturbations, T <- T Exp(xi). The cost functions of this file
/// differentiate by xi and leave the seventh column of their Jacobians zero, so that the Jacobian
/// of Plus is simply a cut identity.
class PoseManifold final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
};

/// RelativePoseResidual times S, where S^T S is its information.
class RelativePoseCost final : public ceres::SizedCostFunction<6, 7, 7> {
 public:
  RelativePoseCost(const Pose& T_from_to, const Matrix6d& sqrt_information)
      : T_from_to_(T_from_to), sqrt_information_(sqrt_information) {}
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  Pose T_from_to_;
  Matrix6d sqrt_information_;
};

/// TiltResidual over its standard deviation [rad].
class TiltCost final : public ceres::SizedCostFunction<2, 7> {
 public:
  TiltCost(const Eigen::Vector3d& up_imu, double sigma) : up_imu_(up_imu), sigma_(sigma) {}
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  Eigen::Vector3d up_imu_;
  double sigma_;
};

/// S with S^T S = information, for a symmetric positive semidefinite matrix.
Matrix6d SquareRoot(const Matrix6d& information);

/// Poses, weighted constraints between them, and their least squares solution by Ceres: the
/// numeric core of the pose graph, which knows indices instead of keyframes. The first pose of
/// every part that constraints connect is held.
class GraphSolver {
 public:
  struct Result {
    bool converged = false;
    int iterations = 0;
    double initial_cost = 0.0;  ///< half the sum of squared residuals
    double final_cost = 0.0;
  };

  explicit GraphSolver(const std::vector<Pose>& poses);

  /// Does nothing for a weight of zero.
  void AddConstraint(const Measurement& measurement, double weight = 1.0);
  /// `sigma` [rad] of the tilt.
  void AddTilt(const TiltMeasurement& tilt, double sigma);

  /// Stops when an iteration lowers the cost by less than `tolerance` of it.
  Result Solve(int max_iterations, double tolerance);
  std::vector<Pose> Poses() const;

 private:
  void HoldFirstOfEachPart();

  std::vector<PoseBlock> blocks_;
  DisjointSets parts_;
  PoseManifold manifold_;
  ceres::HuberLoss tilt_loss_{1.0};
  ceres::Problem problem_;
};

}  // namespace hv::loop
