#pragma once

#include "hv_core/imu_sample.h"
#include "hv_core/so3.h"
#include "hv_sim/imu_simulator.h"
#include "hv_sim/motion.h"

namespace hv::sim {

/// Integrates specific force and angular velocity from `start`, in the manner of a strapdown
/// navigator with fourth-order steps over two samples: classical Runge-Kutta for the attitude,
/// Simpson's rule for velocity and position.
class Strapdown {
 public:
  explicit Strapdown(const MotionState& start)
      : R_(start.T_world_body.linear()), v_(start.velocity), p_(start.T_world_body.translation()) {}

  void Step(const ImuSample& a, const ImuSample& b, const ImuSample& c, double period) {
    const double h = 2.0 * period;
    const Eigen::Matrix3d R_half = R_ * so3::Exp(HalfTurn(a, b, c, period));
    const Eigen::Matrix3d R_end = R_ * so3::Exp(FullTurn(a, b, c, h));
    const Eigen::Vector3d gravity(0.0, 0.0, -kGravity);
    const Eigen::Vector3d f0 = R_ * a.acceleration + gravity;
    const Eigen::Vector3d f1 = R_half * b.acceleration + gravity;
    const Eigen::Vector3d f2 = R_end * c.acceleration + gravity;
    p_ += h * v_ + h * h / 6.0 * (f0 + 2.0 * f1);
    v_ += h / 6.0 * (f0 + 4.0 * f1 + f2);
    R_ = R_end;
  }

  Pose pose() const { return MakePose(R_, p_); }

 private:
  /// Rotation vector over both intervals: Simpson's rule with the coning correction.
  static Eigen::Vector3d FullTurn(const ImuSample& a, const ImuSample& b, const ImuSample& c,
                                  double h) {
    const Eigen::Vector3d first =
        h / 24.0 * (5.0 * a.angular_velocity + 8.0 * b.angular_velocity - c.angular_velocity);
    const Eigen::Vector3d second =
        h / 24.0 * (-a.angular_velocity + 8.0 * b.angular_velocity + 5.0 * c.angular_velocity);
    return first + second + 2.0 / 3.0 * first.cross(second);
  }

  static Eigen::Vector3d HalfTurn(const ImuSample& a, const ImuSample& b, const ImuSample& c,
                                  double period) {
    return period / 12.0 *
           (5.0 * a.angular_velocity + 8.0 * b.angular_velocity - c.angular_velocity);
  }

  Eigen::Matrix3d R_;
  Eigen::Vector3d v_;
  Eigen::Vector3d p_;
};

}  // namespace hv::sim
