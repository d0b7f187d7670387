#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "hv_core/config.h"
#include "hv_sim/random.h"

namespace hv::sim {

/// What a differential drive is told, in its own frame.
struct DriveCommand {
  double linear_mps = 0.0;   ///< along x [m/s]
  double angular_rps = 0.0;  ///< about z [rad/s]
};

struct DifferentialDriveConfig {
  double max_linear_mps = 1.0;
  double max_angular_rps = 1.5;
  double linear_acceleration = 0.8;   ///< [m/s^2]
  double linear_deceleration = 1.2;   ///< [m/s^2]
  double angular_acceleration = 2.5;  ///< [rad/s^2]
  double angular_deceleration = 3.5;  ///< [rad/s^2]
  double track_m = 0.40;              ///< between the wheels
  double slip = 0.02;                 ///< standard deviation, share of a wheel's motion
  double slip_time_s = 1.0;           ///< correlation time of the slip
  double command_timeout_s = 0.5;     ///< without a command for this long, it brakes

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Where a drive stands on the plane, and how it moves over it.
struct DriveState {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< of the middle between the wheels [m]
  double yaw = 0.0;                                    ///< [rad], not wrapped
  DriveCommand velocity;                               ///< over ground, slip included
};

/// A differential drive on a plane that speeds up and brakes with limits; each wheel slips on its
/// own. Copies go on with the same slip. Not thread-safe.
class DifferentialDrive {
 public:
  DifferentialDrive(const DifferentialDriveConfig& config, std::uint32_t seed);

  /// Puts it somewhere else, standing, without a command.
  void Place(const Eigen::Vector2d& position, double yaw);

  /// Followed, within the limits, until the next one or the timeout. One that is not finite counts
  /// as none and is refused with false.
  bool Command(const DriveCommand& command);

  /// Stands at once, where it stood at `before`; the command stays.
  void HaltAt(const DriveState& before);

  /// Moves on by `dt` [s] with constant accelerations of the ground velocities, integrated exactly
  /// to machine precision for turns of up to a radian.
  void Step(double dt);

  const DriveState& state() const { return state_; }

 private:
  DriveCommand GroundVelocity(double dt);
  void Integrate(const DriveCommand& end, double dt);

  DifferentialDriveConfig config_;
  Random random_;
  DriveState state_;
  DriveCommand command_;
  DriveCommand wheels_;  ///< velocity that the wheels turn for
  double command_age_s_ = 0.0;
  double left_slip_ = 0.0;
  double right_slip_ = 0.0;
};

}  // namespace hv::sim
