#pragma once

#include <optional>
#include <vector>

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "hv_ros/path_history.h"
#include "localization_engine.h"

namespace hv::relocalize {

/// Sends where the robot is, after each scan while that is known: topics `localization_pose`,
/// `localization_path` and `localization_scan`; the latter two only while somebody listens. The
/// path is that since the place was last found. Not thread-safe.
class LocalizationPublisher {
 public:
  LocalizationPublisher(ros::NodeHandle nh, const LocalizationOutputConfig& config);

  /// `points`: of the scan, in the IMU frame [m].
  void Publish(const LocalizationReport& report, const std::vector<Point>& points);

 private:
  void PublishPath(const LocalizationReport& report);
  void PublishScan(const LocalizationReport& report, const std::vector<Point>& points) const;

  const LocalizationOutputConfig config_;
  ros::Publisher pose_;
  ros::Publisher path_publisher_;
  ros::Publisher scan_;
  PathHistory path_;
  std::optional<Time> path_sent_;
};

}  // namespace hv::relocalize
