#pragma once

#include <string>

#include <geometry_msgs/PoseWithCovarianceStamped.h>

#include "localization_engine.h"

namespace hv::relocalize {

/// The pose of the base in `map_frame` at the scan.
geometry_msgs::PoseWithCovarianceStamped ToPoseWithCovariance(const LocalizationReport& report,
                                                              const std::string& map_frame);

/// What a person knows of the place of the base: within three standard deviations of the message,
/// and as far as configured at least.
PoseGuess GuessFrom(const geometry_msgs::PoseWithCovariance& message,
                    const RelocalizeConfig& least);

/// "x 1.20 m, y -3.40 m, z 0.10 m, heading 90.0 deg".
std::string PlaceOf(const Pose& T_map_base);

/// "0.24 m along (0.39, 0.92, 0.00)" of x y z rx ry rz.
std::string WeakestOf(const Matrix6d& covariance);

}  // namespace hv::relocalize
