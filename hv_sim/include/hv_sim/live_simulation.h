#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <variant>

#include "hv_core/imu_sample.h"
#include "hv_core/scan.h"
#include "hv_sim/depth_camera.h"
#include "hv_sim/live_config.h"
#include "hv_sim/motion.h"
#include "hv_sim/robot_body.h"
#include "hv_sim/world.h"

namespace hv::sim {

/// Where the base truly is. The world is the frame of MotionState.
struct TrueState {
  Time stamp;
  MotionState base;
};

/// The robot has run into something.
struct Collision {
  Time stamp;
  Contact contact;
  int count = 0;  ///< of all so far, this one included
};

/// What the simulation says, stamped on the sensor clock.
using LiveMessage = std::variant<ImuSample, Scan, DepthImage, TrueState, Collision>;

/// A robot with sensors in a world that does what it is told: the loop is closed by whoever reads
/// the messages and gives the commands. The same commands at the same steps give the same messages,
/// whatever the number of threads. Not thread-safe.
class LiveSimulation {
 public:
  using Sink = std::function<void(LiveMessage)>;

  /// `world` is that of `config.clutter_seed()`. Throws InputError when the configuration is not
  /// valid or the robot cannot stand where it is to start.
  LiveSimulation(World world, const LiveConfig& config);
  ~LiveSimulation();

  /// Another obstacle; it is seen and felt from the next step within its time.
  void Add(const TimedBox& box);

  /// Followed until the next one or the timeout. False for one that is not finite: it is ignored.
  bool Command(const DriveCommand& command);

  /// Moves on by a period of the IMU and hands over what comes up to then, in order of time: an IMU
  /// sample at each step; a scan when its revolution is complete, all rays cast in the world as it
  /// is then; the rest when due.
  void Step(const Sink& sink);

  /// Puts the robot, standing, somewhere else; see RobotBody::Place(). Time goes on.
  void Place(const Pose& T_world_base);

  /// The same, to where it started.
  void Reset();

  double time_s() const;  ///< since the start
  double step_s() const;
  Time now() const;  ///< on the sensor clock
  /// Of the base at present.
  MotionState State() const;
  int collisions() const;

  const World& world() const;
  const LiveConfig& config() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hv::sim
