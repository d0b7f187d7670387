#pragma once

namespace hv {

/// For ros::NodeHandle::advertise: who subscribes later gets the last message at once.
inline constexpr bool kLatched = true;

}  // namespace hv
