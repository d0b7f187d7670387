#include "conversions.h"

#include "hv_ros/conversions.h"

namespace hv::lio {

nav_msgs::Odometry ToOdometryMessage(const BodyEstimate& estimate, const std::string& odom_frame,
                                     const std::string& body_frame) {
  nav_msgs::Odometry message;
  message.header.stamp = ToRos(estimate.stamp);
  message.header.frame_id = odom_frame;
  message.child_frame_id = body_frame;
  message.pose.pose = ToPoseMessage(estimate.T_odom_body);
  message.twist.twist.linear = ToVectorMessage(estimate.twist.head<3>());
  message.twist.twist.angular = ToVectorMessage(estimate.twist.tail<3>());
  CopyCovariance(estimate.pose_covariance, message.pose.covariance);
  CopyCovariance(estimate.twist_covariance, message.twist.covariance);
  return message;
}

geometry_msgs::TransformStamped ToTransformMessage(const BodyEstimate& estimate,
                                                   const std::string& odom_frame,
                                                   const std::string& body_frame) {
  geometry_msgs::TransformStamped message;
  message.header.stamp = ToRos(estimate.stamp);
  message.header.frame_id = odom_frame;
  message.child_frame_id = body_frame;
  message.transform = ToTransform(estimate.T_odom_body);
  return message;
}

}  // namespace hv::lio
