#include "pose_message.h"

#include <cmath>
#include <cstdio>

#include "hv_ros/conversions.h"

namespace hv::relocalize {

geometry_msgs::PoseWithCovarianceStamped ToPoseWithCovariance(const LocalizationReport& report,
                                                              const std::string& map_frame) {
  geometry_msgs::PoseWithCovarianceStamped message;
  message.header.stamp = ToRos(report.scan.stamp);
  message.header.frame_id = map_frame;
  message.pose.pose = ToPoseMessage(report.T_map_base);
  CopyCovariance(report.covariance, message.pose.covariance);
  return message;
}

std::string PlaceOf(const Pose& T_map_base) {
  const Eigen::Vector3d t = T_map_base.translation();
  const double heading = std::atan2(T_map_base.linear()(1, 0), T_map_base.linear()(0, 0));
  char text[128];
  std::snprintf(text, sizeof(text), "x %.2f m, y %.2f m, z %.2f m, heading %.1f deg", t.x(), t.y(),
                t.z(), heading * 180.0 / M_PI);
  return text;
}

}  // namespace hv::relocalize
