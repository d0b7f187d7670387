#pragma once

#include <atomic>
#include <optional>
#include <thread>

#include <diagnostic_updater/diagnostic_updater.h>
#include <hv_msgs/TrackedScan.h>
#include <nav_msgs/Odometry.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include "hv_ros/transform_publisher.h"
#include "localization_engine.h"
#include "localization_health.h"
#include "localization_publisher.h"
#include "map_topics.h"
#include "parameters.h"
#include "relocalize_server.h"
#include "scan_queue.h"

namespace hv::relocalize {

/// Localisation in a saved map as a ROS node, for `hv_relocalize_ndt_node` and the nodelet alike.
/// The scan callback converts and queues; one worker thread localises the newest scan. Transforms
/// go out with the odometry and never wait for the worker. Sensor data never raises an error.
class LocalizationNode {
 public:
  /// Reads the private parameters and the map; throws InputError listing every problem of the
  /// parameters, or saying what is wrong with the map.
  LocalizationNode(ros::NodeHandle nh, ros::NodeHandle private_nh);

  ~LocalizationNode();

 private:
  void Advertise(ros::NodeHandle nh);
  void OnScan(const hv_msgs::TrackedScanConstPtr& message);
  void OnOdometry(const nav_msgs::OdometryConstPtr& message);
  void OnTimer();
  std::string ProblemOfInput() const;

  void Run();
  void UpdateTransform(const LocalizerUpdate& update);
  void ReportChanges(const LocalizationReport& report);

  const NodeParameters parameters_;
  LocalizationEngine engine_;
  ScanQueue queue_;
  LocalizationHealth health_;
  TransformPublisher transforms_;
  LocalizationPublisher publisher_;
  MapTopics map_topics_;
  LocalizerState reported_ = LocalizerState::kLost;  ///< worker only
  std::atomic<double> last_scan_s_;                  ///< wall time of the last scan, or the start

  diagnostic_updater::Updater diagnostics_;
  std::optional<RelocalizeServer> server_;
  ros::Subscriber scan_subscriber_;
  ros::Subscriber odometry_subscriber_;
  ros::WallTimer timer_;
  std::thread worker_;
};

}  // namespace hv::relocalize
