#include "uncertain_pose.h"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace hv::loop {

double SquaredDistanceFromIdentity(const UncertainPose& cycle) {
  const Vector6d error = se3::Log(cycle.T_a_b);
  return error.dot(cycle.covariance.ldlt().solve(error));
}

Matrix6d InverseOf(const Matrix6d& matrix) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(matrix);
  const double least = 1e-12 * solver.eigenvalues().maxCoeff();
  const Vector6d inverses = solver.eigenvalues().cwiseMax(least).cwiseInverse();
  return solver.eigenvectors() * inverses.asDiagonal() * solver.eigenvectors().transpose();
}

double ChiSquareQuantile6(double probability) {
  double low = 0.0;
  double high = 200.0;
  for (int i = 0; i < 60; ++i) {
    const double x = 0.5 * (low + high);
    const double above = std::exp(-0.5 * x) * (1.0 + 0.5 * x + 0.125 * x * x);
    (1.0 - above < probability ? low : high) = x;
  }
  return low;
}

}  // namespace hv::loop
