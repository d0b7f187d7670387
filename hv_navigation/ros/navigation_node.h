#pragma once

#include <string>

#include <diagnostic_updater/diagnostic_updater.h>
#include <hv_msgs/TrackedScan.h>
#include <nav_msgs/Odometry.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <ros/subscriber.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include "control_loop.h"
#include "mapping_worker.h"
#include "navigation_health.h"
#include "odometry_buffer.h"
#include "parameters.h"

namespace hv::navigation {

/// Navigation as a ROS node, for `hv_navigation_node` and the nodelet alike. Callbacks only store
/// and queue; one thread maps, one plans, one drives. Messages never raise an error. The robot is
/// stopped when this object ends.
class NavigationNode {
 public:
  /// Reads the private parameters and the grid of the map; throws InputError listing every problem.
  NavigationNode(ros::NodeHandle nh, ros::NodeHandle private_nh);
  ~NavigationNode();

 private:
  void Advertise(ros::NodeHandle nh, ros::NodeHandle private_nh);
  void OnScan(const hv_msgs::TrackedScanConstPtr& message) { mapping_.queue().Push(message); }
  void OnOdometry(const nav_msgs::OdometryConstPtr& message);
  void OnCamera(const sensor_msgs::CameraInfoConstPtr& message) { camera_ = message; }
  void OnImage(const sensor_msgs::ImageConstPtr& message);
  bool OnClear(std_srvs::TriggerRequest& request, std_srvs::TriggerResponse& response);
  bool OnSave(std_srvs::TriggerRequest& request, std_srvs::TriggerResponse& response);
  void OnTimer();

  const NodeParameters parameters_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener listener_;
  OdometryBuffer odometry_;
  MappingWorker mapping_;
  ControlLoop control_;
  NavigationHealth health_;
  sensor_msgs::CameraInfoConstPtr camera_;  ///< callbacks only

  diagnostic_updater::Updater diagnostics_;
  ros::Subscriber scan_subscriber_;
  ros::Subscriber odometry_subscriber_;
  ros::Subscriber camera_subscriber_;
  ros::Subscriber image_subscriber_;
  ros::ServiceServer clear_service_;
  ros::ServiceServer save_service_;
  ros::WallTimer timer_;
};

}  // namespace hv::navigation
