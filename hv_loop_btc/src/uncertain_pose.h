#pragma once

#include "hv_core/se3.h"

namespace hv::loop {

/// A relative pose T_a_b with the covariance of its right-multiplied error xi, where the true pose
/// is T_a_b Exp(xi); first order in xi.
struct UncertainPose {
  Pose T_a_b = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();
};

/// T_a_c of independent T_a_b and T_b_c.
inline UncertainPose operator*(const UncertainPose& a, const UncertainPose& b) {
  const Matrix6d adjoint = se3::Adjoint(b.T_a_b.inverse());
  return {a.T_a_b * b.T_a_b, adjoint * a.covariance * adjoint.transpose() + b.covariance};
}

inline UncertainPose Inverse(const UncertainPose& pose) {
  const Matrix6d adjoint = se3::Adjoint(pose.T_a_b);
  return {pose.T_a_b.inverse(), adjoint * pose.covariance * adjoint.transpose()};
}

/// Mahalanobis distance squared of a pose that closes a cycle from the identity: chi-square of 6
/// degrees of freedom if the cycle is consistent.
double SquaredDistanceFromIdentity(const UncertainPose& cycle);

/// Information from covariance or back: the inverse of a symmetric positive semidefinite matrix,
/// whose eigenvalues below 1e-12 of the largest count as that.
Matrix6d InverseOf(const Matrix6d& matrix);

/// Value that a chi-square variable of 6 degrees of freedom stays below with `probability`.
double ChiSquareQuantile6(double probability);

}  // namespace hv::loop
