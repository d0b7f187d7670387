#include "explore_server.h"

#include <utility>
#include <vector>

#include <ros/console.h>

#include "hv_ros/message_checks.h"
#include "hv_ros/newest_transform.h"
#include "pose_message.h"

namespace hv::explore {
namespace {

constexpr bool kStartLater = false;

hv_msgs::ExploreResult ToMessage(const ExplorationResult& result) {
  const ExplorationProgress& progress = result.progress;
  hv_msgs::ExploreResult message;
  message.success = result.success;
  message.reason = result.reason;
  message.explored_m2 = progress.explored_m2;
  message.frontiers = static_cast<std::uint32_t>(progress.frontiers);
  message.travelled_m = progress.travelled_m;
  message.elapsed_s = progress.elapsed_s;
  message.goals = static_cast<std::uint32_t>(progress.goals);
  message.failed_goals = static_cast<std::uint32_t>(progress.failed_goals);
  return message;
}

hv_msgs::ExploreResult Refusal(const std::string& reason) {
  hv_msgs::ExploreResult message;
  message.reason = reason;
  return message;
}

}  // namespace

ExploreServer::ExploreServer(ros::NodeHandle private_nh, std::string map_frame,
                             const tf2_ros::Buffer& transforms)
    : map_frame_(std::move(map_frame)),
      transforms_(transforms),
      action_(private_nh, "explore", kStartLater),
      goal_publisher_(private_nh.advertise<hv_msgs::ExploreActionGoal>("explore/goal", 1)) {
  action_.start();
}

ExploreServer::~ExploreServer() {
  Abort("the node ends");
  action_.shutdown();
}

void ExploreServer::AskForAll() {
  hv_msgs::ExploreActionGoal goal;
  goal.header.stamp = ros::Time::now();
  goal_publisher_.publish(goal);
}

std::optional<ExplorationTask> ExploreServer::TakeTask() {
  if (!action_.isNewGoalAvailable()) return std::nullopt;
  const hv_msgs::ExploreGoalConstPtr goal = action_.acceptNewGoal();
  if (!goal) return std::nullopt;
  ExplorationTask task;
  const std::string problem = Read(*goal, task);
  if (problem.empty()) return task;
  ROS_WARN_STREAM(problem);
  Abort(problem);
  return std::nullopt;
}

/// Returns what is wrong with a goal, or nothing.
std::string ExploreServer::Read(const hv_msgs::ExploreGoal& goal, ExplorationTask& task) const {
  const auto& points = goal.bounds.polygon.points;
  const std::string& named = goal.bounds.header.frame_id;
  const std::string& frame = named.empty() ? map_frame_ : named;
  const auto T_map_frame = NewestTransform(transforms_, map_frame_, frame);
  if (!points.empty() && !T_map_frame) {
    return "tf cannot bring the bounds from '" + frame + "' into " + map_frame_;
  }
  std::vector<Eigen::Vector2d> corners;
  for (const geometry_msgs::Point32& point : points) {
    const Eigen::Vector3d corner = T_map_frame->T_parent_child * ToVector(point).cast<double>();
    corners.emplace_back(corner.head<2>());
  }
  task.bounds = Bounds(std::move(corners));
  task.time_budget_s = goal.time_budget_s;
  task.return_home = goal.return_home != 0;
  return ProblemOf(task);
}

void ExploreServer::PublishFeedback(const ExplorerOutput& output, const Explorer& explorer) {
  if (!Active()) return;
  const ExplorationProgress& progress = explorer.progress();
  hv_msgs::ExploreFeedback feedback;
  feedback.state = ToString(output.state);
  feedback.reason = output.reason;
  feedback.explored_m2 = progress.explored_m2;
  feedback.frontiers = static_cast<std::uint32_t>(progress.frontiers);
  feedback.travelled_m = progress.travelled_m;
  feedback.elapsed_s = progress.elapsed_s;
  if (explorer.goal()) feedback.goal = ToPoseStamped(explorer.goal()->pose, map_frame_);
  action_.publishFeedback(feedback);
}

void ExploreServer::Finish(const ExplorationResult& result) {
  if (!Active()) return;
  if (result.end == ExplorationEnd::kCancelled) {
    action_.setPreempted(ToMessage(result), result.reason);
  } else if (result.success) {
    action_.setSucceeded(ToMessage(result), result.reason);
  } else {
    action_.setAborted(ToMessage(result), result.reason);
  }
}

void ExploreServer::Abort(const std::string& reason) {
  if (Active()) action_.setAborted(Refusal(reason), reason);
}

}  // namespace hv::explore
