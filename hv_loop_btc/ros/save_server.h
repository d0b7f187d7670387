#pragma once

#include <actionlib/server/simple_action_server.h>
#include <hv_msgs/SaveMapAction.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <ros/spinner.h>
#include <std_srvs/Trigger.h>

#include "map_saving.h"

namespace hv::loop {

/// Action and service `~save_map`. Both save in threads of their own, so that nothing else in the
/// node waits for them.
class SaveServer {
 public:
  /// `saving` must outlive this object.
  SaveServer(ros::NodeHandle private_nh, MapSaving& saving);
  ~SaveServer();

  /// Answers no more. A save that is under way is waited for: see MapSaving::GiveUp().
  void Stop();

 private:
  using ActionServer = actionlib::SimpleActionServer<hv_msgs::SaveMapAction>;

  void OnGoal(const hv_msgs::SaveMapGoalConstPtr& goal);
  bool OnRequest(std_srvs::TriggerRequest& request, std_srvs::TriggerResponse& response);

  MapSaving& saving_;
  ros::NodeHandle service_nh_;
  ros::CallbackQueue service_queue_;
  ros::ServiceServer service_;
  ros::AsyncSpinner spinner_;
  ActionServer action_;
};

}  // namespace hv::loop
