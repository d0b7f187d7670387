#pragma once

#include <string>

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "hv_relocalize_ndt/localizer_config.h"
#include "hv_relocalize_ndt/prior_map.h"

namespace hv::relocalize {

/// The saved map to look at and to plan in, sent once and latched: `map_cloud`, thinned, and the
/// 2-D grid `map`, when the map has one.
class MapTopics {
 public:
  /// Throws InputError when the grid of the map is damaged.
  MapTopics(ros::NodeHandle nh, const LocalizationOutputConfig& config, const PriorMap& map);

 private:
  void PublishCloud(ros::NodeHandle& nh, const PriorMap& map);
  void PublishGrid(ros::NodeHandle& nh, const PriorMap& map);

  const LocalizationOutputConfig config_;
  ros::Publisher cloud_;
  ros::Publisher grid_;
};

}  // namespace hv::relocalize
