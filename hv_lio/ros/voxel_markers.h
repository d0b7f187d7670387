#pragma once

#include <string>
#include <vector>

#include <visualization_msgs/MarkerArray.h>

#include "hv_core/time.h"
#include "hv_lio/voxel_view.h"

namespace hv::lio {

/// The map as in Fig. 12 of the paper, one triangle list per kind so that tens of thousands of
/// voxels stay light for rviz: `planes` (circles: locally fitted planes), `merged_planes` (squares,
/// coloured by plane) and `gaussians` (ellipsoids of one standard deviation). At most 24 corners
/// (about 1 kB) a voxel.
visualization_msgs::MarkerArray ToVoxelMarkers(const std::vector<VoxelView>& voxels,
                                               const std::string& frame, Time stamp);

}  // namespace hv::lio
