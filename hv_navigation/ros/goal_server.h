#pragma once

#include <optional>
#include <string>

#include <actionlib/server/simple_action_server.h>
#include <geometry_msgs/PoseStamped.h>
#include <move_base_msgs/MoveBaseAction.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>
#include <tf2_ros/buffer.h>

#include "hv_navigation/navigator.h"

namespace hv::navigation {

/// The action `move_base`, and the topic `move_base_simple/goal` for rviz. Asked once a control
/// cycle instead of calling back, so that goals and cycles need no common lock. All but the
/// constructor is for one thread.
class GoalServer {
 public:
  /// `transforms` must outlive this object.
  GoalServer(ros::NodeHandle nh, std::string map_frame, const tf2_ros::Buffer& transforms);
  ~GoalServer();

  /// A goal that has come since the last time, in the map. One that makes no sense is answered
  /// here and leaves none under way.
  std::optional<PlanarPose> TakeGoal();

  /// Whether a goal is under way, for the client.
  bool Active() { return action_.isActive(); }
  bool CancelRequested() { return action_.isActive() && action_.isPreemptRequested(); }

  /// Where the base is in the map.
  void PublishFeedback(const Pose& T_map_base, Time stamp);

  void Finish(NavigationResult result, const std::string& reason);
  void Abort(const std::string& reason);

 private:
  using ActionServer = actionlib::SimpleActionServer<move_base_msgs::MoveBaseAction>;

  void OnSimpleGoal(const geometry_msgs::PoseStampedConstPtr& message);
  std::string Read(const geometry_msgs::PoseStamped& target, PlanarPose& goal) const;

  const std::string map_frame_;
  const tf2_ros::Buffer& transforms_;
  ActionServer action_;
  ros::Publisher goal_publisher_;
  ros::Publisher current_goal_;
  ros::Subscriber simple_goal_;
};

}  // namespace hv::navigation
