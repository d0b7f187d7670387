#pragma once

#include <optional>
#include <string>

#include <actionlib/server/simple_action_server.h>
#include <hv_msgs/ExploreAction.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <tf2_ros/buffer.h>

#include "hv_explore_sac/explorer.h"

namespace hv::explore {

/// The action `~explore`. Asked in each cycle instead of calling back. For one thread.
class ExploreServer {
 public:
  /// `transforms` must outlive this object.
  ExploreServer(ros::NodeHandle private_nh, std::string map_frame,
                const tf2_ros::Buffer& transforms);
  ~ExploreServer();

  /// A task that has come since the last time. One that makes no sense is answered here and leaves
  /// none under way.
  std::optional<ExplorationTask> TakeTask();

  /// Asks for everything to be explored, as a client would.
  void AskForAll();

  bool Active() { return action_.isActive(); }
  bool CancelRequested() { return action_.isActive() && action_.isPreemptRequested(); }

  void PublishFeedback(const ExplorerOutput& output, const Explorer& explorer);
  void Finish(const ExplorationResult& result);
  void Abort(const std::string& reason);

 private:
  using ActionServer = actionlib::SimpleActionServer<hv_msgs::ExploreAction>;

  std::string Read(const hv_msgs::ExploreGoal& goal, ExplorationTask& task) const;

  const std::string map_frame_;
  const tf2_ros::Buffer& transforms_;
  ActionServer action_;
  ros::Publisher goal_publisher_;
};

}  // namespace hv::explore
