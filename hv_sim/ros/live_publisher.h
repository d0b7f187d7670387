#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include "hv_sim/live_simulation.h"
#include "parameters.h"

namespace hv::sim {

/// Owns the topics of the simulation node. Not thread-safe.
class LivePublisher {
 public:
  LivePublisher(ros::NodeHandle nh, const SimulationNodeConfig& config);

  /// What stands in the world, and where the sensors sit; both latched.
  void PublishWorld(const World& world, Time stamp);

  void PublishClock(Time now);
  void PublishPeople(const World& world, double time_s, Time stamp);

  void operator()(const ImuSample& sample);
  void operator()(const Scan& scan);
  void operator()(const DepthImage& image);
  void operator()(const TrueState& state);
  void operator()(const Collision& collision);

 private:
  const SimulationNodeConfig config_;
  ros::Publisher clock_;
  ros::Publisher imu_;
  ros::Publisher points_;
  ros::Publisher depth_;
  ros::Publisher camera_info_;
  ros::Publisher truth_;
  ros::Publisher collision_;
  ros::Publisher world_;
  ros::Publisher people_;
  tf2_ros::StaticTransformBroadcaster static_transforms_;
  tf2_ros::TransformBroadcaster transforms_;
};

}  // namespace hv::sim
