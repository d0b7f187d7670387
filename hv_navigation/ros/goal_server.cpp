#include "goal_server.h"

#include <utility>

#include <ros/console.h>

#include "frames.h"
#include "hv_ros/conversions.h"
#include "hv_ros/latched.h"
#include "hv_ros/message_checks.h"

namespace hv::navigation {
namespace {

constexpr bool kStartLater = false;

}  // namespace

GoalServer::GoalServer(ros::NodeHandle nh, std::string map_frame, const tf2_ros::Buffer& transforms)
    : map_frame_(std::move(map_frame)),
      transforms_(transforms),
      action_(nh, "move_base", kStartLater),
      goal_publisher_(nh.advertise<move_base_msgs::MoveBaseActionGoal>("move_base/goal", 1)),
      current_goal_(nh.advertise<geometry_msgs::PoseStamped>("current_goal", 1, kLatched)),
      simple_goal_(nh.subscribe("move_base_simple/goal", 1, &GoalServer::OnSimpleGoal, this)) {
  action_.start();
}

GoalServer::~GoalServer() {
  simple_goal_.shutdown();
  if (Active()) Abort("the node ends");
  action_.shutdown();
}

/// By way of the action, so that there is one way in.
void GoalServer::OnSimpleGoal(const geometry_msgs::PoseStampedConstPtr& message) {
  move_base_msgs::MoveBaseActionGoal goal;
  goal.header.stamp = ros::Time::now();
  goal.goal.target_pose = *message;
  goal_publisher_.publish(goal);
}

/// Returns what is wrong with a goal, or nothing.
std::string GoalServer::Read(const geometry_msgs::PoseStamped& target, PlanarPose& goal) const {
  if (!IsPose(target.pose)) return "the goal is not a finite pose with a unit quaternion";
  const std::string& frame = target.header.frame_id;
  const auto T_map_frame = NewestTransform(transforms_, map_frame_, frame);
  if (!T_map_frame) return "tf cannot bring the goal from '" + frame + "' into " + map_frame_;
  const Pose T_map_goal = T_map_frame->T_parent_child * FromRos(target.pose);
  goal = Planar(T_map_goal);
  geometry_msgs::PoseStamped shown;
  shown.header.frame_id = map_frame_;
  shown.header.stamp = ros::Time::now();
  shown.pose = ToPoseMessage(T_map_goal);
  current_goal_.publish(shown);
  return "";
}

std::optional<PlanarPose> GoalServer::TakeGoal() {
  if (!action_.isNewGoalAvailable()) return std::nullopt;
  const move_base_msgs::MoveBaseGoalConstPtr message = action_.acceptNewGoal();
  if (!message) return std::nullopt;
  PlanarPose goal;
  const std::string problem = Read(message->target_pose, goal);
  if (problem.empty()) return goal;
  ROS_WARN_STREAM(problem);
  Abort(problem);
  return std::nullopt;
}

void GoalServer::PublishFeedback(const Pose& T_map_base, Time stamp) {
  if (!Active()) return;
  move_base_msgs::MoveBaseFeedback feedback;
  feedback.base_position.header.frame_id = map_frame_;
  feedback.base_position.header.stamp = ToRos(stamp);
  feedback.base_position.pose = ToPoseMessage(T_map_base);
  action_.publishFeedback(feedback);
}

void GoalServer::Finish(NavigationResult result, const std::string& reason) {
  if (!Active()) return;
  const move_base_msgs::MoveBaseResult none;
  switch (result) {
    case NavigationResult::kReached:
      action_.setSucceeded(none, "Goal reached.");
      break;
    case NavigationResult::kCancelled:
      action_.setPreempted(none, "Goal cancelled.");
      break;
    default:
      action_.setAborted(none, std::string(ToString(result)) + ": " + reason);
  }
}

void GoalServer::Abort(const std::string& reason) {
  if (Active()) action_.setAborted(move_base_msgs::MoveBaseResult(), reason);
}

}  // namespace hv::navigation
