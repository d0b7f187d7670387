#pragma once

#include <string>

#include <hv_msgs/Keyframe.h>
#include <Eigen/Core>

#include "hv_core/keyframe.h"

namespace hv {

/// What a keyframe message tells beside the keyframe.
struct KeyframeHeader {
  Time scan_start;  ///< firing time of the first point
  std::string odom_frame;
  std::string imu_frame;
  Eigen::Vector3d lidar_in_imu = Eigen::Vector3d::Zero();  ///< position of the LiDAR [m]
};

hv_msgs::KeyframePtr ToMessage(const Keyframe& keyframe, const KeyframeHeader& header);

/// A keyframe as read from a message. `error` is empty unless the message is unusable; then it says
/// why in one line and the rest means nothing.
struct DecodedKeyframe {
  Keyframe keyframe;
  KeyframeHeader header;
  std::string error;
};

/// Nothing in the message is trusted: every number is checked before it is used. Points that are
/// not finite are left out.
DecodedKeyframe FromMessage(const hv_msgs::Keyframe& message);

}  // namespace hv
