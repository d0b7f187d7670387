#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace hv {

/// Rigid transform. `T_a_b` is the pose of frame b in frame a: p_a = T_a_b * p_b.
using Pose = Eigen::Isometry3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Pose from a rotation matrix and a translation [m].
Pose MakePose(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation);
Pose MakePose(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation);

/// Rotation by roll, pitch, yaw [rad]: Rz(yaw) Ry(pitch) Rx(roll).
Eigen::Matrix3d RotationFromRpy(double roll, double pitch, double yaw);

/// Rotation angle [rad] in [0, pi] of the relative rotation of two poses.
double RotationDistance(const Pose& a, const Pose& b);

}  // namespace hv

/// SE(3) with tangent vectors ordered translation, then rotation; perturbations are
/// right-multiplied: T <- T Exp(xi). Formulas as in Sola, Deray, Atchuthan (2018), Eq. numbers
/// beside each. All functions are pure.
namespace hv::se3 {

/// Eq. 172.
Pose Exp(const Vector6d& xi);

/// Inverse of Exp (Eq. 173), rotation part at most pi.
Vector6d Log(const Pose& pose);

/// Ad with T Exp(xi) T^-1 = Exp(Ad xi) (Eq. 175).
Matrix6d Adjoint(const Pose& pose);

/// J_r with Exp(xi + d) = Exp(xi) Exp(J_r d) to first order (Eq. 179-180).
Matrix6d RightJacobian(const Vector6d& xi);

/// Inverse of RightJacobian; rotation part below 2 pi.
Matrix6d RightJacobianInverse(const Vector6d& xi);

/// J_l with Exp(xi + d) = Exp(J_l d) Exp(xi) to first order.
inline Matrix6d LeftJacobian(const Vector6d& xi) { return RightJacobian(-xi); }

/// Inverse of LeftJacobian; rotation part below 2 pi.
inline Matrix6d LeftJacobianInverse(const Vector6d& xi) { return RightJacobianInverse(-xi); }

}  // namespace hv::se3
