#pragma once

#include <memory>
#include <optional>
#include <string>

#include <diagnostic_updater/diagnostic_updater.h>
#include <nav_msgs/OccupancyGrid.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_server.h>
#include <ros/subscriber.h>
#include <std_srvs/SetBool.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include "exploration_health.h"
#include "explore_server.h"
#include "goal_client.h"
#include "hv_explore_sac/online/online_learner.h"
#include "parameters.h"

namespace hv::explore {

/// Exploration as a ROS node, for `hv_explore_sac_node` and the nodelet alike. Everything runs in
/// the thread of the callbacks. Messages never raise an error. The goal under way is cancelled when
/// this object ends.
class ExplorationNode {
 public:
  /// Reads the private parameters; throws InputError listing every problem.
  ExplorationNode(ros::NodeHandle nh, ros::NodeHandle private_nh);
  ~ExplorationNode();

 private:
  void OnMap(const nav_msgs::OccupancyGridConstPtr& message);
  bool OnPause(std_srvs::SetBoolRequest& request, std_srvs::SetBoolResponse& response);
  void OnTimer();
  void TakeRequests();
  ExplorerInput ReadInputs();
  std::optional<Pose> PlaceOfRobot(Time now) const;
  void Act(const ExplorerOutput& output);
  void Report(const ExplorerOutput& output);
  void Publish();
  void DescribeLearning(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  const NodeParameters parameters_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener listener_;
  std::shared_ptr<OnlineLearner> learner_;  ///< null: nothing is learned
  Explorer explorer_;
  GoalClient navigation_;
  ExploreServer server_;
  ExplorationHealth health_;
  std::shared_ptr<const OccupancyGrid> map_;
  bool starts_by_itself_;
  double height_m_ = 0.0;  ///< of the robot in the map, to draw at
  ExplorerState state_ = ExplorerState::kIdle;
  ros::Time published_;
  int cycles_ = 0;

  diagnostic_updater::Updater diagnostics_;
  ros::Publisher viewpoints_;
  ros::Publisher frontiers_;
  ros::Subscriber map_subscriber_;
  ros::ServiceServer pause_service_;
  ros::WallTimer timer_;
};

}  // namespace hv::explore
