#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "hv_core/se3.h"
#include "hv_core/time.h"

namespace hv::loop {

/// Two submaps that may show the same place.
struct LoopCandidate {
  std::uint32_t query = 0;  ///< keyframe of the newer submap
  std::uint32_t match = 0;  ///< keyframe of the older one
  Time query_stamp;
  Time match_stamp;
  Pose T_match_query = Pose::Identity();
  int votes = 0;               ///< triangles that agree
  int inliers = 0;             ///< of these, with one relative pose
  double plane_overlap = 0.0;  ///< after alignment by the triangles, 0 to 1
  double fitness = 0.0;        ///< of the fine alignment, 0 to 1
  double overlap = 0.0;        ///< of the fine alignment, 0 to 1
  double seen_through = 0.0;   ///< share of points that the other submap sees through, 0 to 1
  bool accepted = false;
  std::string reason;  ///< why not accepted, one line

  /// How well the submaps fit, 0 to 1. A look-alike gives itself away by surfaces that the other
  /// submap sees through: 2 % of them weigh as much as a third of the fit.
  double score() const { return fitness * overlap * std::exp(-seen_through / 0.02); }
};

}  // namespace hv::loop
