#include "simulation_node.h"

#include <algorithm>
#include <utility>

#include <ros/console.h>
#include <tbb/global_control.h>

#include "hv_core/config.h"
#include "hv_core/error.h"
#include "live_messages.h"

namespace hv::sim {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr double kPeoplePeriod_s = 0.1;

LiveSimulation MakeSimulation(const LiveConfig& config) {
  return LiveSimulation(MakeWorld(config.world, config.clutter_seed()), config);
}

/// Keeps simulated and real time apart by a factor. Time that was lost is not made up for.
class Pace {
 public:
  explicit Pace(double rate) : rate_(rate) {}

  void Wait(double simulated_s) {
    if (rate_ <= 0.0) return;
    constexpr double kLost_s = 0.2;
    due_ += ros::WallDuration(simulated_s / rate_);
    const ros::WallTime now = ros::WallTime::now();
    if (due_ > now) (due_ - now).sleep();
    if (now - due_ > ros::WallDuration(kLost_s)) due_ = now;
  }

 private:
  double rate_;
  ros::WallTime due_ = ros::WallTime::now();
};

}  // namespace

SimulationNode::SimulationNode(ros::NodeHandle nh, ros::NodeHandle private_nh)
    : config_(ReadParameters(private_nh)),
      simulation_(MakeSimulation(config_.simulation)),
      publisher_(nh, config_),
      described_at_(ros::WallTime::now()),
      diagnostics_(nh, private_nh, private_nh.getNamespace()) {
  ROS_INFO_STREAM("configuration:\n" << ToYaml(config_));
  const Eigen::Vector3d start = simulation_.State().T_world_body.translation();
  ROS_INFO_STREAM("world " << simulation_.world().name << ", start at " << start.transpose());
  diagnostics_.setHardwareID("none");
  diagnostics_.add("simulation", this, &SimulationNode::Describe);
  velocity_subscriber_ = nh.subscribe("cmd_vel", 10, &SimulationNode::OnVelocity, this,
                                      ros::TransportHints().tcpNoDelay());
  reset_service_ = private_nh.advertiseService("reset", &SimulationNode::OnReset, this);
  timer_ = nh.createWallTimer(ros::WallDuration(1.0), [this](const auto&) { OnTimer(); });
  thread_ = std::thread([this] { Run(); });
}

SimulationNode::~SimulationNode() {
  timer_.stop();
  velocity_subscriber_.shutdown();
  reset_service_.shutdown();
  ending_ = true;
  if (thread_.joinable()) thread_.join();
}

void SimulationNode::OnVelocity(const geometry_msgs::TwistConstPtr& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  shared_.command = DriveCommand{message->linear.x, message->angular.z};
}

bool SimulationNode::OnReset(std_srvs::Trigger::Request& /*request*/,
                             std_srvs::Trigger::Response& response) {
  const std::lock_guard<std::mutex> lock(mutex_);
  shared_.reset = true;
  response.success = 1;
  response.message = "the robot goes back to its start with the next step; the clock runs on";
  return true;
}

void SimulationNode::OnTimer() { diagnostics_.force_update(); }

void SimulationNode::Describe(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const ros::WallTime now = ros::WallTime::now();
  const std::lock_guard<std::mutex> lock(mutex_);
  const double wall_s = std::max(1e-3, (now - described_at_).toSec());
  const double speed = (shared_.time_s - described_time_s_) / wall_s;
  described_at_ = now;
  described_time_s_ = shared_.time_s;
  constexpr double kSlow = 0.8;
  if (config_.rate > 0.0 && speed < kSlow * config_.rate) {
    status.summary(DiagnosticStatus::WARN, "slower than wanted: lower point_share or rate");
  } else {
    status.summary(DiagnosticStatus::OK, "running");
  }
  status.addf("simulated seconds per second", "%.2f", speed);
  status.addf("time [s]", "%.1f", shared_.time_s);
  status.add("commands", shared_.commands);
  status.add("commands refused", shared_.refused_commands);
  status.add("collisions", shared_.collisions);
  status.add("last collision", shared_.last_collision);
  status.add("resets", shared_.resets);
}

void SimulationNode::Run() {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(config_.threads));
  publisher_.PublishWorld(simulation_.world(), simulation_.now());
  Pace pace(config_.rate);
  double people_due_s = 0.0;
  while (!ending_ && ros::ok()) {
    Obey();
    Step();
    if (simulation_.time_s() >= people_due_s) {
      publisher_.PublishPeople(simulation_.world(), simulation_.time_s(), simulation_.now());
      people_due_s += kPeoplePeriod_s;
    }
    pace.Wait(simulation_.step_s());
  }
}

/// Carries out what has been asked for since the last step.
void SimulationNode::Obey() {
  std::optional<DriveCommand> command;
  bool reset = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    command = std::exchange(shared_.command, std::nullopt);
    reset = std::exchange(shared_.reset, false);
    shared_.resets += reset ? 1 : 0;
    shared_.commands += command ? 1 : 0;
  }
  if (reset) simulation_.Reset();
  if (!command || simulation_.Command(*command)) return;
  ROS_WARN_THROTTLE(5.0, "a velocity that is not finite is ignored");
  const std::lock_guard<std::mutex> lock(mutex_);
  ++shared_.refused_commands;
}

void SimulationNode::Step() {
  publisher_.PublishClock(simulation_.now());
  simulation_.Step([this](const LiveMessage& message) {
    std::visit(publisher_, message);
    if (const Collision* collision = std::get_if<Collision>(&message)) Report(*collision);
  });
  const std::lock_guard<std::mutex> lock(mutex_);
  shared_.time_s = simulation_.time_s();
}

void SimulationNode::Report(const Collision& collision) {
  const std::string kind = KindOf(collision.contact);
  ROS_WARN_STREAM("collision " << collision.count << ": " << kind << " at "
                               << collision.contact.velocity.linear_mps << " m/s, "
                               << collision.contact.T_world_base.translation().transpose());
  const std::lock_guard<std::mutex> lock(mutex_);
  shared_.collisions = collision.count;
  shared_.last_collision = kind;
}

}  // namespace hv::sim
