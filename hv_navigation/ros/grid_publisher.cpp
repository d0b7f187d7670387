#include "grid_publisher.h"

#include <nav_msgs/OccupancyGrid.h>

#include "hv_ros/conversions.h"
#include "hv_ros/latched.h"

namespace hv::navigation {

GridPublisher::GridPublisher(ros::NodeHandle nh, const NavigationNodeOptions& options)
    : options_(options),
      map_(nh.advertise<nav_msgs::OccupancyGrid>("map", 1, kLatched)),
      local_grid_(nh.advertise<nav_msgs::OccupancyGrid>("local_grid", 1)) {}

void GridPublisher::PublishFirstMap(const ClearanceGrid& map) { PublishMap(map, Time()); }

void GridPublisher::PublishMap(const ClearanceGrid& map, Time stamp) {
  nav_msgs::OccupancyGrid message = ToGridMessage(map.grid());
  message.header.frame_id = options_.map_frame;
  message.header.stamp = message.info.map_load_time = ToRos(stamp);
  map_.publish(message);
}

void GridPublisher::Publish(const SurroundingsView& view, const TrackedScanHeader& scan) {
  if (view.local && local_grid_.getNumSubscribers() > 0) {
    nav_msgs::OccupancyGrid message = ToGridMessage(view.local->grid());
    message.header.frame_id = scan.odom_frame;
    message.header.stamp = message.info.map_load_time = ToRos(scan.stamp);
    local_grid_.publish(message);
  }
  const bool due =
      !sent_at_ || scan.stamp < *sent_at_ || scan.stamp - *sent_at_ >= options_.map_period_s;
  if (!view.map || view.map == sent_ || !due || map_.getNumSubscribers() == 0) return;
  PublishMap(*view.map, scan.stamp);
  sent_ = view.map;
  sent_at_ = scan.stamp;
}

}  // namespace hv::navigation
