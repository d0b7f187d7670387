#pragma once

#include <mutex>
#include <optional>
#include <string>

#include <nav_msgs/Odometry.h>
#include <tf2_ros/transform_broadcaster.h>

#include "hv_loop_btc/mapping_config.h"
#include "map_correction.h"

namespace hv::loop {

/// Publishes map -> odom with every odometry message, so that its stamps are those of odom -> base
/// plus a small tolerance, whatever clock the data have. Thread-safe.
class TransformPublisher {
 public:
  explicit TransformPublisher(const MappingNodeConfig& config);

  /// A new value: moved to smoothly, or at once when the place in the map was unknown before.
  void Update(const Pose& T_map_odom, bool at_once);

  void OnOdometry(const nav_msgs::Odometry& odometry);

 private:
  const MappingNodeConfig config_;
  std::mutex mutex_;  // guards everything below
  MapCorrection correction_;
  std::optional<Time> last_;  ///< stamp of the last transform
  tf2_ros::TransformBroadcaster broadcaster_;
};

}  // namespace hv::loop
