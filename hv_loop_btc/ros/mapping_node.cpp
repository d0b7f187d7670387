#include "mapping_node.h"

#include <chrono>
#include <iostream>

#include <ros/console.h>

#include "hv_core/config.h"
#include "hv_core/elapsed.h"

namespace hv::loop {
namespace {

constexpr std::size_t kKeyframesInMemory = 20;
constexpr std::uint32_t kKeyframeQueue = 1000;
constexpr std::uint32_t kOdometryQueue = 100;
// roslaunch kills 15 s after an interrupt.
constexpr double kTimeToEnd = 13.0;        // [s]
constexpr double kTimeForKeyframes = 5.0;  // of these, for keyframes that still wait [s]

using Clock = std::chrono::steady_clock;

TransformOptions TransformsOf(const MappingNodeConfig& config) {
  return {config.map_frame, config.publish_tf, config.tf_tolerance_s, config.correction_s};
}

/// After an interrupt rosconsole prints no more.
void TellAtExit(const std::string& line) { std::cerr << "hv_loop_btc: " << line << std::endl; }

}  // namespace

MappingNode::MappingNode(ros::NodeHandle nh, ros::NodeHandle private_nh)
    : parameters_(ReadParameters(private_nh)),
      engine_(parameters_.config.loop, parameters_.WorkFolder(), parameters_.continue_map),
      queue_(parameters_.WorkFolder(), kKeyframesInMemory),
      saving_(engine_, parameters_.config, parameters_.map_path),
      health_(engine_, queue_, saving_, parameters_.WorkFolder()),
      transforms_(TransformsOf(parameters_.config.mapping)),
      display_(nh, parameters_.config, engine_),
      reported_(engine_.state()),
      diagnostics_(nh, private_nh, private_nh.getNamespace()) {
  ROS_INFO_STREAM("configuration:\n" << ToYaml(parameters_.config));
  if (!parameters_.continue_map.empty()) {
    ROS_INFO_STREAM("continuing " << parameters_.continue_map << " with " << reported_.keyframes
                                  << " keyframes; map -> odom is the identity until a loop joins");
  }
  save_server_.emplace(private_nh, saving_);
  Advertise(nh);
  worker_ = std::thread([this] { Run(); });
}

MappingNode::~MappingNode() {
  const Clock::time_point start = Clock::now();
  timer_.stop();
  keyframe_subscriber_.shutdown();
  odometry_subscriber_.shutdown();
  saving_.GiveUp();
  display_.Stop();
  save_server_.reset();
  queue_.Close();
  while (queue_.counters().waiting > 0 && SecondsSince(start) < kTimeForKeyframes) {
    ros::WallDuration(0.02).sleep();
  }
  abandon_queue_ = true;
  if (worker_.joinable()) worker_.join();
  SaveAtExit(kTimeToEnd - SecondsSince(start));
}

void MappingNode::Advertise(ros::NodeHandle nh) {
  diagnostics_.setHardwareID("none");
  diagnostics_.add("loop closing", &health_, &MappingHealth::DescribeLoops);
  diagnostics_.add("map", &health_, &MappingHealth::DescribeMap);
  keyframe_subscriber_ = nh.subscribe("keyframe", kKeyframeQueue, &MappingNode::OnKeyframe, this);
  odometry_subscriber_ = nh.subscribe("odometry", kOdometryQueue, &MappingNode::OnOdometry, this,
                                      ros::TransportHints().tcpNoDelay());
  timer_ = nh.createWallTimer(ros::WallDuration(1.0), [this](const auto&) { OnTimer(); });
}

void MappingNode::OnKeyframe(const hv_msgs::KeyframeConstPtr& message) { queue_.Push(message); }

void MappingNode::OnOdometry(const nav_msgs::OdometryConstPtr& message) {
  transforms_.OnOdometry(*message);
}

void MappingNode::OnTimer() {
  const bool wants_odometry = parameters_.config.mapping.publish_tf;
  std::string problem;
  if (keyframe_subscriber_.getNumPublishers() == 0) {
    problem = "nobody publishes " + keyframe_subscriber_.getTopic();
  } else if (wants_odometry && odometry_subscriber_.getNumPublishers() == 0) {
    problem = "nobody publishes " + odometry_subscriber_.getTopic() + ": no map -> odom";
  }
  health_.SetProblem(problem);
  diagnostics_.force_update();
}

void MappingNode::Run() {
  while (!abandon_queue_) {
    const hv_msgs::KeyframeConstPtr message = queue_.Pop();
    if (!message) break;
    engine_.Add(FromMessage(*message));
    ReportChanges(engine_.state());
  }
  const std::size_t left_out = queue_.counters().waiting;
  if (left_out > 0) TellAtExit(std::to_string(left_out) + " keyframes left out: no time");
  engine_.Finish();
}

void MappingNode::ReportChanges(const LoopState& state) {
  if (state.unusable != reported_.unusable) ROS_WARN_STREAM_THROTTLE(1.0, state.last_error);
  if (reported_.joined && !state.joined) {
    ROS_WARN_STREAM("the odometry has started anew: its place in the map is unknown");
  }
  if (!reported_.joined && state.joined) ROS_INFO_STREAM("joined: the place in the map is known");
  if (state.optimized != reported_.optimized) ROS_INFO_STREAM(state.optimization);
  // Besides loops, every keyframe moves it a little once systematic drift is taken out.
  constexpr double kRounding = 1e-9;
  const bool moved = !state.T_map_odom.isApprox(reported_.T_map_odom, kRounding);
  const bool at_once = state.joined != reported_.joined;
  if (moved || at_once) transforms_.Update(state.T_map_odom, at_once);
  reported_ = state;
}

void MappingNode::SaveAtExit(double seconds) {
  if (!parameters_.config.mapping.autosave) return;
  const SaveOutcome outcome = saving_.SaveAtExit(seconds);
  if (outcome.message.empty()) return;
  TellAtExit((outcome.success ? "map saved in " : "map not saved: ") + outcome.message);
}

}  // namespace hv::loop
