#pragma once

#include <std_msgs/ColorRGBA.h>
#include <visualization_msgs/Marker.h>

namespace hv {

/// Parts from 0 to 1.
inline std_msgs::ColorRGBA Color(float r, float g, float b, float a = 1.0F) {
  std_msgs::ColorRGBA color;
  color.r = r;
  color.g = g;
  color.b = b;
  color.a = a;
  return color;
}

/// Of one size along all axes, at the origin of its frame; the header is left to the caller.
inline visualization_msgs::Marker MakeMarker(const char* name, int type, double scale_m,
                                             const std_msgs::ColorRGBA& color) {
  visualization_msgs::Marker marker;
  marker.ns = name;
  marker.type = type;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = scale_m;
  marker.color = color;
  return marker;
}

}  // namespace hv
