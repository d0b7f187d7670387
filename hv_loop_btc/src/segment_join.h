#pragma once

#include <cstddef>
#include <vector>

#include "disjoint_sets.h"
#include "measurement.h"
#include "odometry_chains.h"

namespace hv::loop {

struct JoinRule {
  double threshold = 0.0;       ///< squared Mahalanobis distance of two loops that agree
  std::size_t least_loops = 2;  ///< that must agree with each other
};

/// Joins chains that are not connected yet (`parts`) where enough `loops` between the same two
/// agree with each other by way of odometry (pairwise consistency; Mangelson, Dominic, Eustice,
/// Vasudevan 2018): the part of the later chain moves as a whole to where the loop with most
/// support puts it.
void JoinSegments(const JoinRule& rule, const OdometryChains& chains,
                  const std::vector<Measurement>& loops, DisjointSets& parts,
                  std::vector<Pose>& poses);

}  // namespace hv::loop
