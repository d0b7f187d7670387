#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "hv_core/config.h"
#include "hv_core/time.h"
#include "hv_navigation/footprint.h"
#include "hv_navigation/planar.h"

namespace hv::navigation {

/// How those who walk are taken to go on: straight, at a speed between two bounds; or, as long as
/// the robot moves, any way.
struct WalkConfig {
  double least_mps = 0.6;
  double most_mps = 1.3;
  double any_way_mps = 1.3;
  double any_way_m = 0.1;
  double horizon_s = 1.5;
  double radius_m = 0.3;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Somebody who walks, when last noticed.
struct Walker {
  Time stamp;
  Eigen::Vector2d place;      ///< [m]
  Eigen::Vector2d direction;  ///< unit
};

/// Where those who walk may be in the next seconds, in the frame of odometry. Immutable; const
/// methods may run concurrently.
class Walkers {
 public:
  /// `perhaps`: what has just appeared; it may be somebody, and go any way.
  Walkers(const WalkConfig& config, std::vector<Walker> walkers, std::vector<Walker> perhaps = {})
      : config_(config), walkers_(std::move(walkers)), perhaps_(std::move(perhaps)) {}

  const WalkConfig& config() const { return config_; }
  const std::vector<Walker>& all() const { return walkers_; }

  /// Whether one of them may touch a robot that is at `pose` then, with its margin, walking on.
  bool MayTouch(const Footprint& footprint, const PlanarPose& pose, Time then) const;
  /// The same for who may turn, and for what has just appeared.
  bool MayReach(const Footprint& footprint, const PlanarPose& pose, Time then) const;

  /// Whether one of them may be within `distance_m` of `place` then.
  bool MayBeNear(const Eigen::Vector2d& place, double distance_m, Time then) const;
  /// Whether `walker` may be within `distance_m` of `place` then.
  static bool MayBeNear(const WalkConfig& config, const Walker& walker,
                        const Eigen::Vector2d& place, double distance_m, Time then);

 private:
  WalkConfig config_;
  std::vector<Walker> walkers_;
  std::vector<Walker> perhaps_;
};

}  // namespace hv::navigation
