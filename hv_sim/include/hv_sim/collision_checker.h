#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "hv_core/config.h"
#include "hv_core/se3.h"
#include "hv_sim/pedestrian.h"
#include "hv_sim/ray_caster.h"
#include "hv_sim/world.h"

namespace hv::sim {

/// The room that a robot takes up, in its base frame: a box that stands above the ground.
struct RobotShape {
  double front_m = 0.30;  ///< from the origin of the base
  double back_m = 0.30;
  double half_width_m = 0.25;
  double bottom_m = 0.04;  ///< lower things are driven over
  double top_m = 0.70;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Horizontal gaps between the footprint and what stands at the height of the robot [m]; 0: they
/// touch.
struct Clearance {
  double static_m = 0.0;
  double person_m = 0.0;

  double least() const { return std::min(static_m, person_m); }
};

/// Exact for triangles and, seen from above, for the capsules that people are made of. The inside
/// of closed surfaces counts as free. Const methods are thread-safe.
class CollisionChecker {
 public:
  CollisionChecker(const RobotShape& shape, std::shared_ptr<const RayCaster> scene,
                   std::vector<PersonPath> people);

  /// Another static scene from now on.
  void SetScene(std::shared_ptr<const RayCaster> scene) { scene_ = std::move(scene); }

  /// Of a robot at `T_world_base` at `time_s`; gaps beyond `limit_m` are given as `limit_m`.
  Clearance At(const Pose& T_world_base, double time_s, double limit_m) const;

  const RobotShape& shape() const { return shape_; }

 private:
  double StaticGap(const Pose& T_world_base, double limit_m) const;
  double PersonGap(const Pose& T_base_world, double time_s, double limit_m) const;

  RobotShape shape_;
  std::shared_ptr<const RayCaster> scene_;
  std::vector<PersonPath> people_;
};

}  // namespace hv::sim
