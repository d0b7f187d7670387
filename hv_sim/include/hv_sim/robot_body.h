#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hv_core/config.h"
#include "hv_sim/collision_checker.h"
#include "hv_sim/differential_drive.h"
#include "hv_sim/motion.h"
#include "hv_sim/world.h"

namespace hv::sim {

struct RobotBodyConfig {
  DifferentialDriveConfig drive;
  RobotShape shape;
  double wheel_base_m = 0.40;
  double vibration = 1.0;  ///< of a moving robot, 1: about 1 mm and 0.2 deg

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

enum class ContactKind { kObstacle, kPerson, kEdge };

/// The robot ran into something, or stopped before a place without floor.
struct Contact {
  double time_s = 0.0;
  ContactKind kind = ContactKind::kObstacle;
  DriveCommand velocity;  ///< with which it arrived; 0 when a person walked into it
  Pose T_world_base = Pose::Identity();
};

/// A robot that drives over the floors of a world. What would take it into something else is not
/// done: it stands at once. Its motion is a C^4 spline with exact derivatives; a command takes 20
/// to 60 ms to show. Origin: base_link, on the floor between the wheels, x forward. At() is
/// thread-safe, the rest not.
class RobotBody {
 public:
  RobotBody(const RobotBodyConfig& config, std::shared_ptr<const RayCaster> scene,
            std::vector<PersonPath> people, std::uint32_t seed);
  ~RobotBody();

  /// Other static surroundings from now on.
  void SetScene(std::shared_ptr<const RayCaster> scene);

  /// Puts the robot, standing, on the floor under a pose: its position, up to 0.5 m above the
  /// floor, and heading count. Throws InputError where there is no floor.
  void Place(const Pose& T_world_base);

  /// See DifferentialDrive::Command().
  bool Command(const DriveCommand& command);

  /// Moves on; gives the contacts that have begun since. A contact lasts until the robot has got
  /// away from it.
  std::vector<Contact> AdvanceTo(double time_s);

  /// At any time from half a second before the last AdvanceTo() to 10 ms after it.
  MotionState At(double time_s) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hv::sim
