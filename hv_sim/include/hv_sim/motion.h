#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "hv_core/config.h"
#include "hv_core/se3.h"
#include "hv_sim/world.h"

namespace hv::sim {

/// Exact state of one rigid frame at one instant. `body` is the frame that a trajectory describes:
/// x forward, y left, z up, its origin where the LiDAR is carried.
struct MotionState {
  Pose T_world_body = Pose::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();              ///< world frame [m/s]
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();          ///< world frame [m/s^2]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();      ///< body frame [rad/s]
  Eigen::Vector3d angular_acceleration = Eigen::Vector3d::Zero();  ///< body frame [rad/s^2]
};

/// State of a frame bolted to the body, lever arm included; the result speaks of that frame where
/// MotionState says body.
MotionState Attached(const MotionState& body, const Pose& T_body_frame);

/// A smooth (C^4) trajectory with analytic derivatives, defined on [0, duration] seconds; it stands
/// perfectly still for the first `still_s` seconds. Const methods are thread-safe.
class Motion {
 public:
  virtual ~Motion() = default;
  virtual MotionState At(double time_s) const = 0;
};

struct MotionConfig {
  std::string style = "walk";  ///< one of MotionStyles()
  double duration_s = 60.0;
  double still_s = 2.0;  ///< standing still at the start
  double skip_s = 0.0;   ///< this much has passed at time 0; beyond still_s: a start in motion
  int seed = 1;          ///< phases of the sway, places of the stops; a Recording sets it

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// walk (handheld), robot (differential drive), segway (pitching), aggressive (handheld, fast).
std::vector<std::string> MotionStyles();

/// Follows `world.route` (again and again when closed, back and forth when open) in the given
/// style, within 0.3 m. Throws InputError for an unknown style or a route without length.
std::unique_ptr<Motion> MakeMotion(const World& world, const MotionConfig& config);

}  // namespace hv::sim
