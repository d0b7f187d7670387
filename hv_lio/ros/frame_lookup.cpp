#include "frame_lookup.h"

#include <ros/time.h>

#include "hv_ros/conversions.h"

namespace hv::lio {

std::optional<Pose> FrameLookup::Wait(const std::string& parent, const std::string& child,
                                      double timeout_s) {
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(timeout_s);
  while (!stop_) {
    if (buffer_._frameExists(parent) && buffer_._frameExists(child) &&
        buffer_.canTransform(parent, child, ros::Time(0))) {
      return FromRos(buffer_.lookupTransform(parent, child, ros::Time(0)).transform);
    }
    if (ros::WallTime::now() >= deadline) break;
    ros::WallDuration(0.02).sleep();
  }
  return std::nullopt;
}

}  // namespace hv::lio
