#include "hv_sim/differential_drive.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hv::sim {
namespace {

struct Limits {
  double faster = 0.0;  ///< rate at which the magnitude may grow
  double slower = 0.0;
};

/// `value` moved towards `target` for `dt` [s]; a change of sign takes a stop in between.
double Approached(double value, double target, const Limits& limits, double dt) {
  if (value * target < 0.0) target = 0.0;
  const bool slower = std::abs(target) < std::abs(value);
  const double step = (slower ? limits.slower : limits.faster) * dt;
  return value + std::clamp(target - value, -step, step);
}

}  // namespace

void DifferentialDriveConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("max_linear_mps", max_linear_mps, "highest speed, either way [m/s]");
  visitor.Field("max_angular_rps", max_angular_rps, "highest rate of turn [rad/s]");
  visitor.Field("linear_acceleration", linear_acceleration, "highest [m/s^2]");
  visitor.Field("linear_deceleration", linear_deceleration, "highest [m/s^2]");
  visitor.Field("angular_acceleration", angular_acceleration, "highest [rad/s^2]");
  visitor.Field("angular_deceleration", angular_deceleration, "highest [rad/s^2]");
  visitor.Field("track_m", track_m, "distance between the wheels [m]");
  visitor.Field("slip", slip, "standard deviation of a wheel's slip, share of its motion");
  visitor.Field("slip_time_s", slip_time_s, "time over which slip stays alike [s]");
  visitor.Field("command_timeout_s", command_timeout_s, "silence after which it brakes [s]");
}

void DifferentialDriveConfig::Validate(ConfigProblems& problems) const {
  const auto positive = [&problems](const char* key, double value) {
    problems.Require(value > 0.0, std::string("drive.") + key, "must be positive");
  };
  positive("max_linear_mps", max_linear_mps);
  positive("max_angular_rps", max_angular_rps);
  positive("linear_acceleration", linear_acceleration);
  positive("linear_deceleration", linear_deceleration);
  positive("angular_acceleration", angular_acceleration);
  positive("angular_deceleration", angular_deceleration);
  positive("track_m", track_m);
  positive("slip_time_s", slip_time_s);
  positive("command_timeout_s", command_timeout_s);
  problems.Require(slip >= 0.0 && slip <= 0.3, "drive.slip", "must be in [0, 0.3]");
}

DifferentialDrive::DifferentialDrive(const DifferentialDriveConfig& config, std::uint32_t seed)
    : config_(config), random_({seed, 0xD21FEU}) {}

void DifferentialDrive::Place(const Eigen::Vector2d& position, double yaw) {
  state_ = {position, yaw, {}};
  wheels_ = command_ = {};
}

bool DifferentialDrive::Command(const DriveCommand& command) {
  const bool finite = std::isfinite(command.linear_mps) && std::isfinite(command.angular_rps);
  if (!finite) return false;
  const DifferentialDriveConfig& limit = config_;
  command_ = {std::clamp(command.linear_mps, -limit.max_linear_mps, limit.max_linear_mps),
              std::clamp(command.angular_rps, -limit.max_angular_rps, limit.max_angular_rps)};
  command_age_s_ = 0.0;
  return true;
}

void DifferentialDrive::HaltAt(const DriveState& before) {
  state_ = {before.position, before.yaw, {}};
  wheels_ = {};
}

/// Of the wheels after `dt`, less what they lose to slip.
DriveCommand DifferentialDrive::GroundVelocity(double dt) {
  const double kept = std::exp(-dt / config_.slip_time_s);
  const double fresh = config_.slip * std::sqrt(1.0 - kept * kept);
  left_slip_ = kept * left_slip_ + fresh * random_.Gauss();
  right_slip_ = kept * right_slip_ + fresh * random_.Gauss();
  const double half_track = 0.5 * config_.track_m;
  const double left = (wheels_.linear_mps - half_track * wheels_.angular_rps) * (1.0 + left_slip_);
  const double right =
      (wheels_.linear_mps + half_track * wheels_.angular_rps) * (1.0 + right_slip_);
  return {0.5 * (left + right), (right - left) / config_.track_m};
}

void DifferentialDrive::Step(double dt) {
  command_age_s_ += dt;
  const DriveCommand target =
      command_age_s_ > config_.command_timeout_s ? DriveCommand{} : command_;
  wheels_.linear_mps = Approached(wheels_.linear_mps, target.linear_mps,
                                  {config_.linear_acceleration, config_.linear_deceleration}, dt);
  wheels_.angular_rps =
      Approached(wheels_.angular_rps, target.angular_rps,
                 {config_.angular_acceleration, config_.angular_deceleration}, dt);
  Integrate(GroundVelocity(dt), dt);
}

/// The way is a Fresnel integral: Gauss-Legendre quadrature of order ten.
void DifferentialDrive::Integrate(const DriveCommand& end, double dt) {
  constexpr std::array<double, 5> kNodes = {-0.9061798459386640, -0.5384693101056831, 0.0,
                                            0.5384693101056831, 0.9061798459386640};
  constexpr std::array<double, 5> kWeights = {0.2369268850561891, 0.4786286704993665,
                                              0.5688888888888889, 0.4786286704993665,
                                              0.2369268850561891};
  const DriveCommand& begin = state_.velocity;
  const double turn = end.angular_rps - begin.angular_rps;
  Eigen::Vector2d way = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < kNodes.size(); ++i) {
    const double share = 0.5 * (1.0 + kNodes[i]);
    const double yaw = state_.yaw + dt * share * (begin.angular_rps + 0.5 * share * turn);
    const double speed = begin.linear_mps + share * (end.linear_mps - begin.linear_mps);
    way += 0.5 * kWeights[i] * dt * speed * Eigen::Vector2d(std::cos(yaw), std::sin(yaw));
  }
  state_.position += way;
  state_.yaw += 0.5 * dt * (begin.angular_rps + end.angular_rps);
  state_.velocity = end;
}

}  // namespace hv::sim
