#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "hv_core/se3.h"
#include "hv_sim/world.h"

namespace hv::sim {

/// Exact state of the body (IMU) frame at one instant.
struct MotionState {
  Pose T_world_imu = Pose::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();              ///< world frame [m/s]
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();          ///< world frame [m/s^2]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();      ///< IMU frame [rad/s]
  Eigen::Vector3d angular_acceleration = Eigen::Vector3d::Zero();  ///< IMU frame [rad/s^2]
};

/// A smooth trajectory with analytic derivatives, defined on [0, duration] seconds; it stands still
/// for the first `still_s` seconds. Const methods are thread-safe.
class Motion {
 public:
  virtual ~Motion() = default;
  virtual MotionState At(double time_s) const = 0;
};

struct MotionConfig {
  std::string style = "walk";  ///< one of MotionStyles()
  double duration_s = 60.0;
  double still_s = 2.0;  ///< standing still at the start
  std::uint32_t seed = 1;
};

/// walk (handheld), robot (differential drive), segway (pitching), aggressive (handheld, fast).
std::vector<std::string> MotionStyles();

/// Follows `world.route` (again and again when closed, back and forth when open) in the given
/// style. Throws InputError for an unknown style.
std::unique_ptr<Motion> MakeMotion(const World& world, const MotionConfig& config);

}  // namespace hv::sim
