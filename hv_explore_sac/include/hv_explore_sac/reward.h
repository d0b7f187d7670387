#pragma once

#include <Eigen/Core>

#include "hv_core/config.h"

namespace hv::explore {

/// Weights and scales of the reward (paper, Eq. 15-20). Lengths are in cells of the belief.
struct RewardConfig {
  double coverage = 5.0;         ///< per explored share (Eq. 15)
  double frontier = 1.0;         ///< per `frontier_scale` frontier points observed (Eq. 16)
  double distribution = 0.0;     ///< per `length_scale` the centroid of frontiers moves (Eq. 17)
  double path = 1.0;             ///< per `length_scale` driven (Eq. 18)
  double completion = 20.0;      ///< at the end (Eq. 19)
  double frontier_scale = 50.0;  ///< [points]
  double length_scale = 64.0;    ///< [cells]

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// What happened between two decisions.
struct Transition {
  double explored_before = 0.0;  ///< share of the free space that is known, 0 to 1
  double explored_after = 0.0;
  int frontiers_observed = 0;  ///< frontier points that are none any more
  bool has_centroids = false;  ///< there were frontiers before and after
  Eigen::Vector2d centroid_before = Eigen::Vector2d::Zero();  ///< of the frontiers [cells]
  Eigen::Vector2d centroid_after = Eigen::Vector2d::Zero();
  double path = 0.0;  ///< driven [cells]
  bool complete = false;
};

/// The five terms, each with its weight and sign.
struct Reward {
  double coverage = 0.0;
  double frontier = 0.0;
  double distribution = 0.0;
  double path = 0.0;  ///< not positive
  double completion = 0.0;

  double Total() const { return coverage + frontier + distribution + path + completion; }  // Eq. 20
};

Reward RewardOf(const Transition& transition, const RewardConfig& config);

}  // namespace hv::explore
