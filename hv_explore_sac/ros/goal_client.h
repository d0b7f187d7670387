#pragma once

#include <optional>
#include <string>

#include <actionlib/client/simple_action_client.h>
#include <move_base_msgs/MoveBaseAction.h>
#include <ros/node_handle.h>

#include "hv_explore_sac/explorer.h"

namespace hv::explore {

/// Gives goals to whoever serves the action `move_base`. For the thread of the callbacks of `nh`.
class GoalClient {
 public:
  GoalClient(ros::NodeHandle nh, std::string map_frame);

  /// Whether anybody takes goals.
  bool Ready() { return client_.isServerConnected(); }

  /// Takes the place of the goal before.
  void Send(const navigation::PlanarPose& goal);
  void Cancel();

  /// How the newest goal has ended, once; nothing for one that was cancelled here.
  std::optional<GoalOutcome> TakeOutcome();

  /// Whether somebody else has given a goal in place of the newest one, once.
  bool TakenOver();

 private:
  using State = actionlib::SimpleClientGoalState;

  void OnDone(const State& state);

  const std::string map_frame_;
  actionlib::SimpleActionClient<move_base_msgs::MoveBaseAction> client_;
  bool under_way_ = false;
  bool taken_over_ = false;
  std::optional<GoalOutcome> outcome_;
};

}  // namespace hv::explore
