#include "exploration_node.h"

#include <chrono>

#include <ros/console.h>
#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/MarkerArray.h>

#include "hv_core/config.h"
#include "hv_explore_sac/policy/planner_maker.h"
#include "hv_ros/conversions.h"
#include "hv_ros/latched.h"
#include "hv_ros/message_checks.h"
#include "hv_ros/newest_transform.h"
#include "viewpoint_markers.h"

namespace hv::explore {
namespace {

constexpr double kCycle_s = 0.2;
constexpr int kCyclesPerReport = 5;
constexpr double kPicture_s = 1.0;

}  // namespace

ExplorationNode::ExplorationNode(ros::NodeHandle nh, ros::NodeHandle private_nh)
    : parameters_(ReadParameters(private_nh)),
      listener_(transforms_, nh),
      learner_(MakeOnlineLearner(parameters_.config.explorer.online_learning,
                                 parameters_.config.explorer.choice.weights)),
      explorer_(parameters_.config.explorer, parameters_.size,
                PlannerMakerOf(parameters_.config.explorer.choice.planner,
                               parameters_.config.explorer.choice.weights, learner_)),
      navigation_(nh, parameters_.config.node.map_frame),
      server_(private_nh, parameters_.config.node.map_frame, transforms_),
      starts_by_itself_(parameters_.config.node.autostart),
      diagnostics_(nh, private_nh, private_nh.getNamespace()),
      viewpoints_(nh.advertise<visualization_msgs::MarkerArray>("viewpoints", 1, kLatched)),
      frontiers_(nh.advertise<sensor_msgs::PointCloud2>("frontiers", 1, kLatched)) {
  ROS_INFO_STREAM("configuration:\n" << ToYaml(parameters_.config));
  diagnostics_.setHardwareID("none");
  diagnostics_.add("exploration", &health_, &ExplorationHealth::Describe);
  if (learner_) diagnostics_.add("learning", [this](auto& status) { DescribeLearning(status); });
  map_subscriber_ = nh.subscribe("map", 1, &ExplorationNode::OnMap, this);
  pause_service_ = private_nh.advertiseService("pause", &ExplorationNode::OnPause, this);
  timer_ = nh.createWallTimer(ros::WallDuration(kCycle_s), [this](const auto&) { OnTimer(); });
}

ExplorationNode::~ExplorationNode() {
  timer_.stop();
  navigation_.Cancel();
}

void ExplorationNode::OnMap(const nav_msgs::OccupancyGridConstPtr& message) {
  auto grid = std::make_shared<OccupancyGrid>();
  std::string problem = ReadGrid(*message, *grid);
  if (message->header.frame_id != parameters_.config.node.map_frame) {
    problem = "a map in frame '" + message->header.frame_id + "' instead of '" +
              parameters_.config.node.map_frame + "'";
  }
  health_.NoteMap(problem, static_cast<double>(message->data.size()));
  if (problem.empty()) {
    map_ = std::move(grid);
  } else {
    ROS_WARN_STREAM_THROTTLE(5.0, problem << " is not used");
  }
}

bool ExplorationNode::OnPause(std_srvs::SetBoolRequest& request,
                              std_srvs::SetBoolResponse& response) {
  response.success = explorer_.Active();
  response.message = "nothing is being explored";
  if (!response.success) return true;
  explorer_.SetPaused(request.data != 0);
  response.message = request.data != 0 ? "paused: the robot stands" : "exploring";
  return true;
}

void ExplorationNode::OnTimer() {
  const auto begin = std::chrono::steady_clock::now();
  TakeRequests();
  const ExplorerOutput output = explorer_.Update(ReadInputs());
  Act(output);
  Report(output);
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
  health_.NoteCycle(taken.count());
  const ros::Time now = ros::Time::now();
  const bool due = now < published_ || (now - published_).toSec() >= kPicture_s;
  if ((due && explorer_.Active()) || output.goal || output.result) Publish();
  if (++cycles_ % kCyclesPerReport == 0) diagnostics_.force_update();
}

void ExplorationNode::TakeRequests() {
  if (starts_by_itself_ && map_ && navigation_.Ready()) {
    starts_by_itself_ = false;
    server_.AskForAll();
  }
  if (const auto task = server_.TakeTask()) {
    ROS_INFO("exploration begins");
    explorer_.Start(*task);
  }
  if (explorer_.Active() && (!server_.Active() || server_.CancelRequested())) explorer_.Cancel();
  if (!navigation_.TakenOver() || !explorer_.Active()) return;
  ROS_WARN(
      "somebody else has given the robot a goal: exploration pauses until it is told to go on");
  explorer_.SetPaused(true);
}

ExplorerInput ExplorationNode::ReadInputs() {
  ExplorerInput input;
  input.now = FromRos(ros::Time::now());
  input.map = map_;
  input.navigation_ready = navigation_.Ready();
  input.outcome = navigation_.TakeOutcome();
  if (const auto T_map_base = PlaceOfRobot(input.now)) {
    input.T_map_base = navigation::Planar(*T_map_base);
    height_m_ = T_map_base->translation().z();
  }
  return input;
}

/// Nothing while nobody tells it any more: a localiser that is lost falls silent.
std::optional<Pose> ExplorationNode::PlaceOfRobot(Time now) const {
  const ExplorationNodeOptions& options = parameters_.config.node;
  const auto transform = NewestTransform(transforms_, options.map_frame, options.base_frame);
  if (!transform) return std::nullopt;
  const bool always = transform->stamp == Time();
  if (!always && now - transform->stamp > options.place_timeout_s) return std::nullopt;
  return transform->T_parent_child;
}

void ExplorationNode::Act(const ExplorerOutput& output) {
  if (output.stop) navigation_.Cancel();
  if (output.goal) navigation_.Send(*output.goal);
  if (output.result) {
    server_.Finish(*output.result);
  } else {
    server_.PublishFeedback(output, explorer_);
  }
}

void ExplorationNode::Report(const ExplorerOutput& output) {
  if (output.goal) {
    ROS_INFO_STREAM("goal: x " << output.goal->position.x() << " m, y " << output.goal->position.y()
                               << " m; " << output.reason);
  }
  if (output.state != state_ && !output.result) {
    ROS_INFO_STREAM(ToString(output.state) << (output.reason.empty() ? "" : ": ") << output.reason);
  }
  if (output.result) {
    const ExplorationProgress& progress = output.result->progress;
    ROS_INFO_STREAM("exploration ended, " << output.result->reason << "; " << progress.explored_m2
                                          << " m^2, " << progress.travelled_m << " m, "
                                          << progress.elapsed_s << " s");
  }
  state_ = output.state;
  health_.Note(output, explorer_.progress());
}

void ExplorationNode::DescribeLearning(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  const OnlineLearningStatus learning = learner_->status();
  if (learning.problem.empty()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, "learns beside the exploration");
  } else {
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, learning.problem);
  }
  status.add("decisions remembered", learning.decisions);
  status.add("updates of the policy", learning.updates);
  status.addf("error of the values", "%.4f", learning.critic_loss);
}

void ExplorationNode::Publish() {
  published_ = ros::Time::now();
  const GoalChooser* chooser = explorer_.chooser();
  if (chooser == nullptr) return;
  const std::string& frame = parameters_.config.node.map_frame;
  if (viewpoints_.getNumSubscribers() > 0) {
    viewpoints_.publish(ToViewpointMarkers(*chooser, explorer_.goal(), frame, height_m_));
  }
  if (frontiers_.getNumSubscribers() == 0) return;
  const sensor_msgs::PointCloud2Ptr cloud = ToCloudMessage(FrontierCloud(*chooser, height_m_));
  cloud->header.frame_id = frame;
  cloud->header.stamp = published_;
  frontiers_.publish(cloud);
}

}  // namespace hv::explore
