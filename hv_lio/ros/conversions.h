#pragma once

#include <string>

#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>

#include "body_estimate.h"

namespace hv::lio {

/// Pose in `odom_frame`, twist in `body_frame`.
nav_msgs::Odometry ToOdometryMessage(const BodyEstimate& estimate, const std::string& odom_frame,
                                     const std::string& body_frame);

geometry_msgs::TransformStamped ToTransformMessage(const BodyEstimate& estimate,
                                                   const std::string& odom_frame,
                                                   const std::string& body_frame);

}  // namespace hv::lio
