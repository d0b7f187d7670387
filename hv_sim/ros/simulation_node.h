#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/Twist.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <ros/subscriber.h>
#include <std_srvs/Trigger.h>

#include "hv_sim/live_simulation.h"
#include "live_publisher.h"
#include "parameters.h"

namespace hv::sim {

/// The closed loop as a ROS node: sensors and clock go out, velocities come in. One thread steps
/// the simulation at the wanted rate; callbacks only leave word for it.
class SimulationNode {
 public:
  /// Reads the private parameters and builds the world; throws InputError listing every problem.
  SimulationNode(ros::NodeHandle nh, ros::NodeHandle private_nh);

  ~SimulationNode();

 private:
  /// What the callbacks and the diagnostics share with the thread.
  struct Shared {
    std::optional<DriveCommand> command;
    bool reset = false;
    std::size_t commands = 0;
    std::size_t refused_commands = 0;
    std::size_t resets = 0;
    int collisions = 0;
    std::string last_collision;
    double time_s = 0.0;
  };

  void OnVelocity(const geometry_msgs::TwistConstPtr& message);
  bool OnReset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void OnTimer();
  void Describe(diagnostic_updater::DiagnosticStatusWrapper& status);

  void Run();
  void Obey();
  void Step();
  void Report(const Collision& collision);

  const SimulationNodeConfig config_;
  LiveSimulation simulation_;  ///< thread only
  LivePublisher publisher_;    ///< thread only
  std::mutex mutex_;           // guards shared_
  Shared shared_;

  double described_time_s_ = 0.0;  ///< of the last diagnostics
  ros::WallTime described_at_;

  diagnostic_updater::Updater diagnostics_;
  ros::Subscriber velocity_subscriber_;
  ros::ServiceServer reset_service_;
  ros::WallTimer timer_;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace hv::sim
