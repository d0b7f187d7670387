#pragma once

#include <string>

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "hv_core/depth_image.h"
#include "hv_navigation/depth_projection.h"

namespace hv::navigation {

/// A depth image as read from messages. `error` is empty unless they are unusable; then it says why
/// in one line and the rest means nothing.
struct DecodedDepth {
  DepthImage image;
  DepthCameraModel camera;
  std::string error;
};

/// Takes rectified images of encoding 16UC1 or mono16 (millimetres) and 32FC1 (metres), in either
/// order of bytes. Nothing in the messages is trusted.
DecodedDepth FromMessages(const sensor_msgs::Image& image, const sensor_msgs::CameraInfo& camera);

}  // namespace hv::navigation
