#pragma once

#include <deque>
#include <optional>
#include <string>

#include <tf2_ros/buffer.h>

#include "hv_core/se3.h"
#include "hv_core/time.h"
#include "hv_ros/newest_transform.h"

namespace hv::navigation {

/// Where odometry lies in the map. A localiser that has lost the place stops telling it, and with
/// it the place is lost here. `newest`: stamp of the newest odometry, of which a transform may be
/// at most `timeout_s` older.
std::optional<Pose> PlaceOfOdometry(const tf2_ros::Buffer& buffer, const std::string& map_frame,
                                    const std::string& odom_frame, Time newest, double timeout_s);

/// Notices that the place in the map has been corrected by so much within two seconds that what was
/// drawn into the map before is misplaced. Not thread-safe.
class PlaceJumps {
 public:
  PlaceJumps(double distance_m, double angle_rad)
      : distance_m_(distance_m), angle_rad_(angle_rad) {}

  /// Whether it has jumped; the same jump is told once.
  bool Add(Time stamp, const Pose& T_map_odom, const Pose& T_odom_base);

 private:
  struct Place {
    Time stamp;
    Pose T_map_odom;
  };

  double distance_m_;
  double angle_rad_;
  std::deque<Place> places_;
};

}  // namespace hv::navigation
