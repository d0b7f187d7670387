#pragma once

#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <ros/node_handle.h>
#include <tf2_ros/buffer.h>

#include "command_gate.h"
#include "drive_publisher.h"
#include "goal_server.h"
#include "hv_core/recent_durations.h"
#include "hv_navigation/navigation_config.h"
#include "hv_navigation/navigator.h"
#include "mapping_worker.h"
#include "odometry_buffer.h"

namespace hv::navigation {

/// What the diagnostics tell of the control cycles.
struct ControlState {
  bool has_goal = false;
  NavigationState state = NavigationState::kIdle;
  std::string reason;
  std::string missing;  ///< input, or nothing
  double remaining_m = 0.0;
  int recoveries = 0;
  double pose_age_s = 0.0;
  double obstacles_age_s = 0.0;
  bool localized = false;
  bool other_clock = false;  ///< sensors are stamped by a clock that is not that of ROS
  std::size_t cycles = 0;
  std::size_t missed = 0;  ///< that began more than a period late
  double cycle_ms = 0.0;
  double longest_cycle_ms = 0.0;
  std::size_t goals = 0;
  std::size_t reached = 0;
  std::string last_result;
};

/// The control cycles, in a thread of their own on the clock of ROS: neither plans nor maps nor
/// callbacks delay them. Takes goals, asks the navigator, and sends velocities. Stops the robot
/// when it ends. Thread-safe.
class ControlLoop {
 public:
  /// All references must outlive this object.
  ControlLoop(ros::NodeHandle nh, const NavigationConfig& config, const tf2_ros::Buffer& transforms,
              const OdometryBuffer& odometry, MappingWorker& mapping);
  ~ControlLoop();

  ControlState state() const;
  /// From the stamp of what the obstacle sensors saw to the first velocity that heeds it, on the
  /// clock of ROS.
  RecentDurations latencies() const;

 private:
  static constexpr std::size_t kTimedVelocities = 10000;

  void Run();
  bool WaitUntil(ros::Time due);
  void Cycle(ros::Time now);
  void FollowClock(Time now);
  void TakeGoals();
  NavigationInput ReadInputs(ros::Time now);
  void Act(const NavigationInput& input, const NavigationOutput& output);
  void NoteLatency(const NavigationInput& input);
  void Note(const NavigationInput& input, const NavigationOutput& output);

  const NavigationConfig config_;
  const tf2_ros::Buffer& transforms_;
  const OdometryBuffer& odometry_;
  MappingWorker& mapping_;
  GoalServer goals_;
  DrivePublisher publisher_;
  std::unique_ptr<Navigator> navigator_;  // this and the next six: of the thread
  CommandGate gate_;
  DrivePose pose_;
  Pose T_map_odom_ = Pose::Identity();
  std::optional<Time> last_;
  bool other_clock_ = false;
  Time heeded_;  // stamp of the newest obstacles that a velocity has heeded

  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable ended_;
  bool ending_ = false;
  ControlState state_;
  RecentDurations latencies_{kTimedVelocities};

  std::thread thread_;  // last: uses all of the above
};

}  // namespace hv::navigation
