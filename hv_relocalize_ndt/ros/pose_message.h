#pragma once

#include <string>

#include <geometry_msgs/PoseWithCovarianceStamped.h>

#include "localization_engine.h"

namespace hv::relocalize {

/// The pose of the base in `map_frame` at the scan.
geometry_msgs::PoseWithCovarianceStamped ToPoseWithCovariance(const LocalizationReport& report,
                                                              const std::string& map_frame);

/// "x 1.20 m, y -3.40 m, z 0.10 m, heading 90.0 deg".
std::string PlaceOf(const Pose& T_map_base);

}  // namespace hv::relocalize
