#pragma once

#include <atomic>
#include <optional>
#include <string>

#include <actionlib/server/simple_action_server.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <hv_msgs/RelocalizeAction.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <ros/subscriber.h>
#include <std_srvs/Trigger.h>

#include "localization_engine.h"

namespace hv::relocalize {

/// Takes what people know or ask about the place: topic `initialpose`, service and action
/// `~relocalize`. The action waits for its answer in a thread of its own.
class RelocalizeServer {
 public:
  /// `engine` must outlive this object.
  RelocalizeServer(ros::NodeHandle nh, ros::NodeHandle private_nh, const LocalizerConfig& config,
                   LocalizationEngine& engine);
  ~RelocalizeServer();

 private:
  using ActionServer = actionlib::SimpleActionServer<hv_msgs::RelocalizeAction>;

  void OnInitialPose(const geometry_msgs::PoseWithCovarianceStampedConstPtr& message);
  bool OnRequest(std_srvs::TriggerRequest& request, std_srvs::TriggerResponse& response);
  void OnGoal(const hv_msgs::RelocalizeGoalConstPtr& goal);
  std::optional<LocalizationReport> WaitForAnswer(std::uint64_t number);
  std::string ProblemOf(const std::string& frame, const geometry_msgs::Pose& pose) const;

  const std::string map_frame_;
  const RelocalizeConfig config_;
  LocalizationEngine& engine_;
  std::atomic<bool> stop_{false};
  ros::Subscriber initial_pose_;
  ros::ServiceServer service_;
  ActionServer action_;
};

}  // namespace hv::relocalize
