#pragma once

#include <cmath>

#include <Eigen/Core>

#include "hv_core/se3.h"

namespace hv::navigation {

/// Where a robot stands on the ground, and which way it looks. As a transform, `a * b` is b, given
/// in the frame that a places.
struct PlanarPose {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< [m]
  double yaw = 0.0;                                    ///< [rad]

  Eigen::Vector2d Ahead() const { return {std::cos(yaw), std::sin(yaw)}; }

  Eigen::Vector2d operator*(const Eigen::Vector2d& point) const {
    const Eigen::Vector2d ahead = Ahead();
    return position + point.x() * ahead + point.y() * Eigen::Vector2d(-ahead.y(), ahead.x());
  }
  PlanarPose operator*(const PlanarPose& other) const {
    return {*this * other.position, yaw + other.yaw};
  }
  PlanarPose Inverse() const {
    const PlanarPose turned{Eigen::Vector2d::Zero(), -yaw};
    return {-(turned * position), -yaw};
  }
};

/// The angle in [-pi, pi].
inline double WrappedAngle(double angle) { return std::remainder(angle, 2.0 * M_PI); }

/// Seen from above.
inline PlanarPose Planar(const Pose& pose) {
  return {pose.translation().head<2>(), std::atan2(pose.linear()(1, 0), pose.linear()(0, 0))};
}

/// What a differential drive is told, in its own frame.
struct Velocity {
  double linear_mps = 0.0;   ///< along x
  double angular_rps = 0.0;  ///< about z [rad/s]
};

}  // namespace hv::navigation
