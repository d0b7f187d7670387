#include "hv_ros/newest_transform.h"

#include <tf2/exceptions.h>

#include "hv_ros/conversions.h"

namespace hv {

std::optional<StampedTransform> NewestTransform(const tf2_ros::Buffer& buffer,
                                                const std::string& parent,
                                                const std::string& child) {
  if (parent == child) return StampedTransform();
  try {
    const auto message = buffer.lookupTransform(parent, child, ros::Time(0));
    const Pose pose = FromRos(message.transform);
    if (!pose.matrix().allFinite()) return std::nullopt;
    return StampedTransform{pose, FromRos(message.header.stamp)};
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

}  // namespace hv
