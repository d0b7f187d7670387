#include "pose_message.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "hv_core/angles.h"
#include "hv_core/pose_covariance.h"
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

PoseGuess GuessFrom(const geometry_msgs::PoseWithCovariance& message,
                    const RelocalizeConfig& least) {
  constexpr double kSigmas = 3.0;
  const auto reach = [&](int row) {
    const double variance = message.covariance[static_cast<std::size_t>(7 * row)];
    return variance > 0.0 ? kSigmas * std::sqrt(variance) : 0.0;
  };
  PoseGuess guess;
  guess.T_map_scan = FromRos(message.pose);
  guess.radius_m = std::max({least.guess_radius_m, reach(0), reach(1)});
  guess.heading_rad =
      std::min(M_PI, std::max(least.guess_heading_deg * kRadiansPerDegree, reach(5)));
  return guess;
}

std::string WeakestOf(const Matrix6d& covariance) {
  const WeakestDirection weakest = WeakestDirectionOf(covariance);
  char text[96];
  std::snprintf(text, sizeof(text), "%.3f m along (%.2f, %.2f, %.2f)", weakest.sigma_m,
                weakest.axis.x(), weakest.axis.y(), weakest.axis.z());
  return text;
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
