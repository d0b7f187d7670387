#pragma once

#include <optional>
#include <string>

#include <tf2_ros/buffer.h>

#include "hv_core/se3.h"
#include "hv_core/time.h"

namespace hv {

struct StampedTransform {
  Pose T_parent_child = Pose::Identity();
  Time stamp;  ///< 1970 for transforms that always hold
};

/// The newest transform that tf has, without waiting. Nullopt when it has none.
std::optional<StampedTransform> NewestTransform(const tf2_ros::Buffer& buffer,
                                                const std::string& parent,
                                                const std::string& child);

}  // namespace hv
