#pragma once

#include <vector>

#include "measurement.h"
#include "odometry_chains.h"

namespace hv::loop {

/// Which loops are true: truncated least squares over loops and odometry, minimised by graduated
/// non-convexity (Yang, Antonante, Tzoumas, Carlone, "Graduated Non-Convexity for Robust Spatial
/// Perception", 2020, section IV) on the skeleton of the graph. Odometry is always trusted. `poses`
/// is where odometry alone leads and moves to the solution. Starting there instead of from the
/// solution that believes all loops keeps many false ones from folding the graph up.
/// `threshold`: squared Mahalanobis residual beyond which a loop is false.
std::vector<bool> JudgeLoops(const OdometryChains& chains, const std::vector<Measurement>& loops,
                             double threshold, std::vector<Pose>& poses);

/// The quick way: whether `fresh` loops agree with a map that `accepted` ones hold already. Then
/// all residuals lie within `threshold`, and the fresh loops raise the cost, their chi-square given
/// the map, no more than true loops would. Moves `poses` to the solution if they agree.
bool LoopsAgree(const OdometryChains& chains, const std::vector<Measurement>& accepted,
                const std::vector<Measurement>& fresh, double threshold, std::vector<Pose>& poses);

}  // namespace hv::loop
