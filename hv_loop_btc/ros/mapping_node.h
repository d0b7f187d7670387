#pragma once

#include <atomic>
#include <optional>
#include <thread>

#include <diagnostic_updater/diagnostic_updater.h>
#include <hv_msgs/Keyframe.h>
#include <nav_msgs/Odometry.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include "hv_ros/transform_publisher.h"
#include "keyframe_queue.h"
#include "loop_engine.h"
#include "map_display.h"
#include "map_saving.h"
#include "mapping_health.h"
#include "parameters.h"
#include "save_server.h"

namespace hv::loop {

/// Loop closing as a ROS node, for `hv_loop_btc_node` and the nodelet alike. The keyframe callback
/// pushes into a queue; one worker thread runs the engine. Transforms go out with the odometry and
/// never wait for the worker; what is drawn and what is saved is made in threads of their own.
/// Keyframes never raise an error.
class MappingNode {
 public:
  /// Reads the private parameters; throws InputError listing every problem of them, and when the
  /// map to continue or the folder for working files is not usable.
  MappingNode(ros::NodeHandle nh, ros::NodeHandle private_nh);

  /// Takes the waiting keyframes in, as far as time allows, and saves the map, if asked to: all
  /// within the 15 s that roslaunch grants.
  ~MappingNode();

 private:
  void Advertise(ros::NodeHandle nh);
  void OnKeyframe(const hv_msgs::KeyframeConstPtr& message);
  void OnOdometry(const nav_msgs::OdometryConstPtr& message);
  void OnTimer();

  void Run();
  void ReportChanges(const LoopState& state);
  void SaveAtExit(double seconds);

  const NodeParameters parameters_;
  LoopEngine engine_;
  KeyframeQueue queue_;
  MapSaving saving_;
  MappingHealth health_;
  TransformPublisher transforms_;
  MapDisplay display_;
  std::atomic<bool> abandon_queue_{false};  ///< while ending: no time for what still waits
  LoopState reported_;                      ///< worker only, after the constructor

  diagnostic_updater::Updater diagnostics_;
  std::optional<SaveServer> save_server_;
  ros::Subscriber keyframe_subscriber_;
  ros::Subscriber odometry_subscriber_;
  ros::WallTimer timer_;
  std::thread worker_;
};

}  // namespace hv::loop
