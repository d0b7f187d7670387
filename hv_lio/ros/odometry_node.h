#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <ros/subscriber.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include "frame_lookup.h"
#include "health.h"
#include "hv_core/trajectory.h"
#include "hv_lio/imu_predictor.h"
#include "input_queue.h"
#include "odometry_engine.h"
#include "odometry_publisher.h"
#include "parameters.h"
#include "topic_watch.h"

namespace hv::lio {

/// The odometry as a ROS node, for `hv_lio_node` and the nodelet alike. Callbacks convert and push
/// into a queue; one worker thread runs the engine and publishes. IMU-rate odometry is predicted in
/// the IMU callback itself and therefore never waits for a scan. Sensor data never raises an error.
class OdometryNode {
 public:
  /// Reads the private parameters; throws InputError listing every problem of them.
  OdometryNode(ros::NodeHandle nh, ros::NodeHandle private_nh);

  /// Finishes the waiting scans and writes the trajectory, if asked to.
  ~OdometryNode();

 private:
  void Advertise(ros::NodeHandle nh, ros::NodeHandle private_nh);
  void OnImu(const sensor_msgs::ImuConstPtr& message);
  void OnCloud(const sensor_msgs::PointCloud2ConstPtr& message);
  bool OnReset(std_srvs::TriggerRequest& request, std_srvs::TriggerResponse& response);
  bool OnPause(std_srvs::SetBoolRequest& request, std_srvs::SetBoolResponse& response);
  void OnTimer();

  void Run();
  bool Prepare();
  std::optional<Pose> WaitForExtrinsic(FrameLookup& frames);
  void Handle(const InputQueue::Input& input);
  void Deliver(const ScanResult& result);
  void ReportChanges(const EngineCounters& counters);
  void SaveTrajectory() const;
  std::string LidarFrame() const;

  NodeParameters parameters_;
  InputQueue queue_;
  Health health_;
  ImuPredictor predictor_;
  OdometryPublisher publisher_;
  TopicWatch cloud_watch_;
  TopicWatch imu_watch_;
  std::atomic<bool> stop_{false};
  std::atomic<bool> paused_{false};

  mutable std::mutex frame_mutex_;
  std::string cloud_frame_;  // of the first cloud; guarded by frame_mutex_

  mutable std::mutex engine_mutex_;
  std::shared_ptr<OdometryEngine> engine_;  // null until prepared; guarded by engine_mutex_

  Trajectory trajectory_;          // worker only
  std::size_t segments_ = 0;       // worker only
  std::size_t faults_ = 0;         // worker only
  std::size_t unusable_ = 0;       // worker only
  bool time_layout_told_ = false;  // worker only

  diagnostic_updater::Updater diagnostics_;
  ros::Subscriber imu_subscriber_;
  ros::Subscriber cloud_subscriber_;
  ros::ServiceServer reset_service_;
  ros::ServiceServer pause_service_;
  ros::WallTimer timer_;
  std::thread worker_;
};

}  // namespace hv::lio
