#pragma once

#include <mutex>
#include <optional>
#include <string>

#include <nav_msgs/Odometry.h>
#include <tf2_ros/transform_broadcaster.h>

#include "hv_ros/map_correction.h"

namespace hv {

/// How map -> odom is published.
struct TransformOptions {
  std::string map_frame = "map";
  bool publish = true;
  double tolerance_s = 0.1;   ///< how far its stamps lie after those of the odometry [s]
  double correction_s = 1.0;  ///< time in which it moves to a new value; 0: at once [s]
};

/// Publishes map -> odom with every odometry message, so that its stamps are those of odom -> base
/// plus a small tolerance, whatever clock the data have. Thread-safe.
class TransformPublisher {
 public:
  /// The identity until told otherwise.
  explicit TransformPublisher(TransformOptions options);

  /// A new value: moved to smoothly, or at once when the place in the map was unknown before.
  void Update(const Pose& T_map_odom, bool at_once);

  /// The place in the map is not known: nothing is published until the next Update().
  void Withdraw();

  void OnOdometry(const nav_msgs::Odometry& odometry);

 private:
  const TransformOptions options_;
  std::mutex mutex_;  // guards everything below
  MapCorrection correction_;
  bool withdrawn_ = false;
  std::optional<Time> last_;  ///< stamp of the last transform
  tf2_ros::TransformBroadcaster broadcaster_;
};

}  // namespace hv
