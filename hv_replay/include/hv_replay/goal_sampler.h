#pragma once

#include <cstdint>
#include <optional>

#include "hv_core/occupancy_grid.h"
#include "hv_navigation/clearance_grid.h"
#include "hv_navigation/footprint.h"
#include "hv_navigation/planar.h"
#include "hv_sim/random.h"

namespace hv::replay {

/// Draws goals anywhere in a map that a robot can get to. The same for the same seed. Not
/// thread-safe.
class GoalSampler {
 public:
  struct Goal {
    navigation::PlanarPose pose;
    /// Of the shortest way over the eight neighbours of a cell for a circle as large as the largest
    /// one inside of the footprint with its margin [m].
    double optimal_m = 0.0;
  };

  GoalSampler(const OccupancyGrid& map, const navigation::Footprint& footprint, std::uint32_t seed);

  /// At any heading, at least `least_m` from `start`, where the robot can turn on the spot, and
  /// connected with the start by places like that; nullopt when there is none.
  std::optional<Goal> Next(const navigation::PlanarPose& start, double least_m);

  const navigation::ClearanceGrid& map() const { return map_; }

 private:
  std::optional<Eigen::Vector2i> OpenCellNear(const Eigen::Vector2d& position) const;
  double OptimalLength(const Eigen::Vector2i& start, const Eigen::Vector2i& goal) const;

  navigation::ClearanceGrid map_;
  double inscribed_m_;
  double circumscribed_m_;
  sim::Random random_;
};

}  // namespace hv::replay
