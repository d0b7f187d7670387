#pragma once

#include <optional>

#include "hv_core/se3.h"
#include "hv_core/time.h"

namespace hv {

/// The published T_map_odom: loop closing and localisation move it in steps, planners want no
/// jumps. A new value is reached within a fixed time, during which the robot would slide and turn
/// at a constant rate from where it was seen to where it is (linear in position, shortest arc in
/// rotation, about the robot and not about the far origin of odom). Not thread-safe.
class MapCorrection {
 public:
  /// `duration_s` 0: new values hold at once.
  explicit MapCorrection(double duration_s) : duration_s_(duration_s) {}

  /// A new value, to which the correction moves from the next At() on.
  void MoveTo(const Pose& T_map_odom) { pending_ = T_map_odom; }

  /// A new value that holds at once: for a first localisation, which corrects nothing.
  void JumpTo(const Pose& T_map_odom);

  /// T_map_odom at `stamp`, with the robot at `T_odom_body`. Stamps grow; one that lies before the
  /// last ends the movement.
  Pose At(Time stamp, const Pose& T_odom_body);

 private:
  struct Movement {
    Time start;
    Pose T_odom_body;
    Pose from;  ///< T_map_odom
    Pose to;
  };

  const double duration_s_;
  Pose T_map_odom_ = Pose::Identity();
  std::optional<Pose> pending_;
  std::optional<Movement> movement_;
};

}  // namespace hv
