#include "drive_publisher.h"

#include <utility>

#include <geometry_msgs/PolygonStamped.h>
#include <geometry_msgs/Twist.h>
#include <nav_msgs/Path.h>

#include "hv_ros/conversions.h"
#include "hv_ros/latched.h"

namespace hv::navigation {
namespace {

nav_msgs::Path ToPathMessage(const Path& path, const std::string& frame, Time stamp, double z) {
  nav_msgs::Path message;
  message.header.frame_id = frame;
  message.header.stamp = ToRos(stamp);
  message.poses.resize(path.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    const PlanarPose& pose = path[i];
    message.poses[i].header = message.header;
    message.poses[i].pose =
        ToPoseMessage(MakePose(RotationFromRpy(0.0, 0.0, pose.yaw),
                               Eigen::Vector3d(pose.position.x(), pose.position.y(), z)));
  }
  return message;
}

}  // namespace

DrivePublisher::DrivePublisher(ros::NodeHandle nh, std::string map_frame,
                               const Footprint& footprint)
    : map_frame_(std::move(map_frame)),
      shape_(footprint),
      velocity_(nh.advertise<geometry_msgs::Twist>("cmd_vel", 10)),
      plan_(nh.advertise<nav_msgs::Path>("plan", 1, kLatched)),
      local_plan_(nh.advertise<nav_msgs::Path>("local_plan", 1)),
      footprint_(nh.advertise<geometry_msgs::PolygonStamped>("footprint", 1)) {}

void DrivePublisher::PublishVelocity(const Velocity& velocity) const {
  geometry_msgs::Twist message;
  message.linear.x = velocity.linear_mps;
  message.angular.z = velocity.angular_rps;
  velocity_.publish(message);
}

void DrivePublisher::PublishPicture(const NavigationOutput& output, const DrivePose& pose) {
  PublishPlan(output, pose);
  if (pose.odom_frame.empty()) return;  // no odometry yet
  if (local_plan_.getNumSubscribers() > 0) {
    local_plan_.publish(ToPathMessage(output.trajectory, pose.odom_frame, pose.stamp,
                                      pose.T_odom_base.translation().z()));
  }
  if (footprint_.getNumSubscribers() > 0) PublishFootprint(pose);
}

void DrivePublisher::PublishPlan(const NavigationOutput& output, const DrivePose& pose) {
  if (output.plan == sent_) return;
  sent_ = output.plan;
  plan_.publish(ToPathMessage(sent_ ? *sent_ : Path(), map_frame_, pose.stamp,
                              pose.T_map_base.translation().z()));
}

void DrivePublisher::PublishFootprint(const DrivePose& pose) const {
  geometry_msgs::PolygonStamped message;
  message.header.frame_id = pose.odom_frame;
  message.header.stamp = ToRos(pose.stamp);
  for (const Eigen::Vector2d& corner : {Eigen::Vector2d(shape_.front_m, shape_.half_width_m),
                                        Eigen::Vector2d(-shape_.back_m, shape_.half_width_m),
                                        Eigen::Vector2d(-shape_.back_m, -shape_.half_width_m),
                                        Eigen::Vector2d(shape_.front_m, -shape_.half_width_m)}) {
    const Eigen::Vector3f at =
        (pose.T_odom_base * Eigen::Vector3d(corner.x(), corner.y(), 0.0)).cast<float>();
    geometry_msgs::Point32 point;
    point.x = at.x();
    point.y = at.y();
    point.z = at.z();
    message.polygon.points.push_back(point);
  }
  footprint_.publish(message);
}

}  // namespace hv::navigation
