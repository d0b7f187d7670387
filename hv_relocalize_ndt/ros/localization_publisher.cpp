#include "localization_publisher.h"

#include <nav_msgs/Path.h>
#include <sensor_msgs/PointCloud2.h>

#include "hv_ros/conversions.h"
#include "pose_message.h"

namespace hv::relocalize {
namespace {

constexpr double kPathPeriod = 0.5;  // between two messages with the whole path [s]

}  // namespace

LocalizationPublisher::LocalizationPublisher(ros::NodeHandle nh,
                                             const LocalizationOutputConfig& config)
    : config_(config),
      path_(config.path_min_distance_m, static_cast<std::size_t>(config.path_max_poses)) {
  pose_ = nh.advertise<geometry_msgs::PoseWithCovarianceStamped>("localization_pose", 20);
  path_publisher_ = nh.advertise<nav_msgs::Path>("localization_path", 2);
  scan_ = nh.advertise<sensor_msgs::PointCloud2>("localization_scan", 2);
}

void LocalizationPublisher::Publish(const LocalizationReport& report,
                                    const std::vector<Point>& points) {
  if (report.update.state == LocalizerState::kLost || points.empty()) return;
  pose_.publish(ToPoseWithCovariance(report, config_.map_frame));
  PublishPath(report);
  if (report.update.registered) PublishScan(report, points);
}

void LocalizationPublisher::PublishPath(const LocalizationReport& report) {
  const Time stamp = report.scan.stamp;
  if (report.update.found) path_.Clear();
  path_.Add(stamp, report.T_map_base);
  const bool due = !path_sent_ || stamp < *path_sent_ || stamp - *path_sent_ >= kPathPeriod;
  if (path_publisher_.getNumSubscribers() == 0 || !due) return;
  path_publisher_.publish(path_.ToMessage(config_.map_frame));
  path_sent_ = stamp;
}

void LocalizationPublisher::PublishScan(const LocalizationReport& report,
                                        const std::vector<Point>& points) const {
  if (scan_.getNumSubscribers() == 0) return;
  const auto message = ToCloudMessage(Transformed(report.update.T_map_imu, points));
  message->header.stamp = ToRos(report.scan.stamp);
  message->header.frame_id = config_.map_frame;
  scan_.publish(message);
}

}  // namespace hv::relocalize
