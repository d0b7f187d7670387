#pragma once

#include <Eigen/Core>

/// Rotations as 3 x 3 matrices. Perturbations are right-multiplied: R <- R Exp(theta), theta in
/// radians. Formulas as in Sola, Deray, Atchuthan, "A micro Lie theory for state estimation in
/// robotics" (2018), Eq. numbers beside each. All functions are pure.
namespace hv::so3 {

/// [v]x with [v]x w = v x w.
Eigen::Matrix3d Hat(const Eigen::Vector3d& v);

/// Rodrigues' formula (Eq. 132).
Eigen::Matrix3d Exp(const Eigen::Vector3d& theta);

/// Inverse of Exp with |theta| <= pi (Eq. 133); accurate near 0 and pi.
Eigen::Vector3d Log(const Eigen::Matrix3d& rotation);

/// J_r with Exp(theta + d) = Exp(theta) Exp(J_r d) to first order (Eq. 143).
Eigen::Matrix3d RightJacobian(const Eigen::Vector3d& theta);

/// Inverse of RightJacobian (Eq. 144); |theta| < 2 pi.
Eigen::Matrix3d RightJacobianInverse(const Eigen::Vector3d& theta);

/// J_l with Exp(theta + d) = Exp(J_l d) Exp(theta) to first order (Eq. 145).
inline Eigen::Matrix3d LeftJacobian(const Eigen::Vector3d& theta) { return RightJacobian(-theta); }

/// Inverse of LeftJacobian (Eq. 146); |theta| < 2 pi.
inline Eigen::Matrix3d LeftJacobianInverse(const Eigen::Vector3d& theta) {
  return RightJacobianInverse(-theta);
}

/// Nearest rotation to `matrix` in the Frobenius norm (SVD).
Eigen::Matrix3d Normalize(const Eigen::Matrix3d& matrix);

}  // namespace hv::so3
