#pragma once

#include <memory>
#include <string>

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "hv_navigation/footprint.h"
#include "hv_navigation/navigator.h"

namespace hv::navigation {

/// Where the robot is at a control cycle, as far as that is known.
struct DrivePose {
  Time stamp;
  std::string odom_frame;
  Pose T_odom_base = Pose::Identity();
  Pose T_map_base = Pose::Identity();
};

/// Sends what the control cycle decides: topics `cmd_vel`, `plan`, `local_plan` and `footprint`.
/// Not thread-safe.
class DrivePublisher {
 public:
  DrivePublisher(ros::NodeHandle nh, std::string map_frame, const Footprint& footprint);

  void PublishVelocity(const Velocity& velocity) const;

  /// The plan when it has changed; the others while somebody listens.
  void PublishPicture(const NavigationOutput& output, const DrivePose& pose);

 private:
  void PublishPlan(const NavigationOutput& output, const DrivePose& pose);
  void PublishFootprint(const DrivePose& pose) const;

  const std::string map_frame_;
  const Footprint shape_;
  ros::Publisher velocity_;
  ros::Publisher plan_;
  ros::Publisher local_plan_;
  ros::Publisher footprint_;
  std::shared_ptr<const Path> sent_;
};

}  // namespace hv::navigation
