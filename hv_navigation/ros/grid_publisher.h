#pragma once

#include <memory>
#include <optional>

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "hv_navigation/navigation_config.h"
#include "hv_navigation/surroundings.h"
#include "hv_ros/tracked_scan_message.h"

namespace hv::navigation {

/// Sends the grids: topics `map`, latched, when it has changed, and `local_grid`; both only while
/// somebody listens. Not thread-safe.
class GridPublisher {
 public:
  GridPublisher(ros::NodeHandle nh, const NavigationNodeOptions& options);

  /// The prior map, for all who come.
  void PublishFirstMap(const ClearanceGrid& map);

  void Publish(const SurroundingsView& view, const TrackedScanHeader& scan);

 private:
  void PublishMap(const ClearanceGrid& map, Time stamp);

  const NavigationNodeOptions options_;
  ros::Publisher map_;
  ros::Publisher local_grid_;
  std::shared_ptr<const ClearanceGrid> sent_;
  std::optional<Time> sent_at_;
};

}  // namespace hv::navigation
