#include "hv_core/se3.h"

#include <cmath>

#include "hv_core/so3.h"

namespace hv {

Pose MakePose(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation) {
  Pose pose = Pose::Identity();
  pose.linear() = rotation;
  pose.translation() = translation;
  return pose;
}

Pose MakePose(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation) {
  return MakePose(rotation.normalized().toRotationMatrix(), translation);
}

Eigen::Matrix3d RotationFromRpy(double roll, double pitch, double yaw) {
  return (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

double RotationDistance(const Pose& a, const Pose& b) {
  return so3::Log(a.linear().transpose() * b.linear()).norm();
}

}  // namespace hv

namespace hv::se3 {
namespace {

/// Q(rho, theta) of the left Jacobian (Eq. 180).
Eigen::Matrix3d LeftJacobianCoupling(const Vector6d& xi) {
  const Eigen::Matrix3d rho = so3::Hat(xi.head<3>());
  const Eigen::Matrix3d theta = so3::Hat(xi.tail<3>());
  const double squared = xi.tail<3>().squaredNorm();
  const double angle = std::sqrt(squared);
  double b = 1.0 / 6.0 - squared / 120.0;
  double c = 1.0 / 24.0 - squared / 720.0;
  double d = 1.0 / 120.0 - squared / 2520.0;
  if (angle > 1e-2) {
    const double sine = std::sin(angle);
    const double cosine = std::cos(angle);
    b = (angle - sine) / (squared * angle);
    c = (0.5 * squared + cosine - 1.0) / (squared * squared);
    d = 0.5 * (c - 3.0 * (sine - angle + squared * angle / 6.0) / (squared * squared * angle));
  }
  const Eigen::Matrix3d rho_theta = rho * theta;
  const Eigen::Matrix3d theta_rho = theta * rho;
  const Eigen::Matrix3d theta_rho_theta = theta * rho_theta;
  return 0.5 * rho + b * (theta_rho + rho_theta + theta_rho_theta) +
         c * (theta * theta_rho + rho_theta * theta - 3.0 * theta_rho_theta) +
         d * (theta_rho_theta * theta + theta * theta_rho_theta);
}

}  // namespace

Pose Exp(const Vector6d& xi) {
  return MakePose(so3::Exp(xi.tail<3>()), so3::LeftJacobian(xi.tail<3>()) * xi.head<3>());
}

Vector6d Log(const Pose& pose) {
  Vector6d xi;
  xi.tail<3>() = so3::Log(pose.linear());
  xi.head<3>() = so3::LeftJacobianInverse(xi.tail<3>()) * pose.translation();
  return xi;
}

Matrix6d Adjoint(const Pose& pose) {
  Matrix6d adjoint = Matrix6d::Zero();
  adjoint.topLeftCorner<3, 3>() = pose.linear();
  adjoint.bottomRightCorner<3, 3>() = pose.linear();
  adjoint.topRightCorner<3, 3>() = so3::Hat(pose.translation()) * pose.linear();
  return adjoint;
}

Matrix6d RightJacobian(const Vector6d& xi) {
  Matrix6d jacobian = Matrix6d::Zero();
  jacobian.topLeftCorner<3, 3>() = so3::RightJacobian(xi.tail<3>());
  jacobian.bottomRightCorner<3, 3>() = jacobian.topLeftCorner<3, 3>();
  jacobian.topRightCorner<3, 3>() = LeftJacobianCoupling(-xi);
  return jacobian;
}

Matrix6d RightJacobianInverse(const Vector6d& xi) {
  const Eigen::Matrix3d inverse = so3::RightJacobianInverse(xi.tail<3>());
  Matrix6d jacobian = Matrix6d::Zero();
  jacobian.topLeftCorner<3, 3>() = inverse;
  jacobian.bottomRightCorner<3, 3>() = inverse;
  jacobian.topRightCorner<3, 3>() = -inverse * LeftJacobianCoupling(-xi) * inverse;
  return jacobian;
}

}  // namespace hv::se3
